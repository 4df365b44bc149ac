#include "mesh/components.hpp"

#include <limits>
#include <numeric>

#include "mesh/precision.hpp"

namespace tegotae {
namespace {

using Box = Eigen::AlignedBox3d;

struct Extent {
  Box box;
  double volume = 0;  ///< signed, m³; of a closed component
};

std::vector<Extent> extents(const TriangleMesh& mesh, const Components& parts) {
  std::vector<Extent> all(parts.count);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    if (parts.of[f] == kNone) continue;
    Extent& e = all[parts.of[f]];
    const auto& t = mesh.triangles[f];
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    e.box.extend(a).extend(b).extend(c);
    e.volume += a.dot(b.cross(c)) / 6;
  }
  return all;
}

/// For every component the one it stays with (itself, unless it is the wall of a cavity).
std::vector<std::uint32_t> owners(const TriangleMesh& mesh, const Topology& topology, const Components& parts) {
  const std::vector<Extent> all = extents(mesh, parts);
  const std::vector<bool> open = open_components(topology, parts);
  std::vector<std::uint32_t> owner(parts.count);
  std::iota(owner.begin(), owner.end(), 0u);
  for (std::uint32_t c = 0; c < parts.count; ++c) {
    if (open[c] || all[c].volume >= 0) continue;
    double smallest = std::numeric_limits<double>::infinity();
    for (std::uint32_t o = 0; o < parts.count; ++o) {
      if (o == c || all[o].volume <= 0 || !all[o].box.contains(all[c].box) || all[o].box.volume() >= smallest) continue;
      smallest = all[o].box.volume();
      owner[c] = o;
    }
  }
  return owner;
}

}  // namespace

Components components(const TriangleMesh& mesh, const Topology& topology) {
  std::vector<std::uint32_t> parent(mesh.triangles.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t f) {
    while (parent[f] != f) f = parent[f] = parent[parent[f]];
    return f;
  };
  std::vector<std::uint32_t> first_face(topology.edges.size(), kNone);
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    if (is_collapsed(mesh.triangles[f])) continue;
    for (const std::uint32_t e : topology.face_edges[f]) {
      if (first_face[e] == kNone)
        first_face[e] = f;
      else
        parent[root(f)] = root(first_face[e]);
    }
  }
  Components out;
  out.of.assign(mesh.triangles.size(), kNone);
  std::vector<std::uint32_t> number(mesh.triangles.size(), kNone);
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    if (is_collapsed(mesh.triangles[f])) continue;
    std::uint32_t& n = number[root(f)];
    if (n == kNone) n = out.count++;
    out.of[f] = n;
  }
  return out;
}

std::vector<bool> open_components(const Topology& topology, const Components& parts) {
  std::vector<bool> open(parts.count, false);
  for (std::size_t h = 0; h < topology.twin.size(); ++h)
    if (topology.twin[h] == kNone && parts.of[h / 3] != kNone) open[parts.of[h / 3]] = true;
  return open;
}

std::vector<TriangleMesh> split(const TriangleMesh& mesh, std::vector<std::uint32_t>& first_face) {
  const Topology topology = build_topology(mesh);
  const Components parts = components(mesh, topology);
  const std::vector<std::uint32_t> owner = owners(mesh, topology, parts);
  std::vector<std::uint32_t> piece(parts.count, kNone);
  std::vector<TriangleMesh> pieces;
  for (std::uint32_t c = 0; c < parts.count; ++c) {
    if (owner[c] != c) continue;
    piece[c] = static_cast<std::uint32_t>(pieces.size());
    pieces.emplace_back();
  }
  first_face.assign(pieces.size(), kNone);
  // A vertex that components share is copied; `copied` tells into which piece it went last and as which vertex.
  std::vector<std::uint32_t> piece_of(mesh.vertices.size(), kNone), copied(mesh.vertices.size(), 0);
  std::vector<std::vector<std::uint32_t>> faces(pieces.size());
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    if (parts.of[f] != kNone) faces[piece[owner[parts.of[f]]]].push_back(f);
  }
  for (std::uint32_t i = 0; i < pieces.size(); ++i) {
    first_face[i] = faces[i].front();
    for (const std::uint32_t f : faces[i]) {
      std::array<std::uint32_t, 3> t = mesh.triangles[f];
      for (std::uint32_t& v : t) {
        if (piece_of[v] != i) {
          piece_of[v] = i;
          copied[v] = static_cast<std::uint32_t>(pieces[i].vertices.size());
          pieces[i].vertices.push_back(mesh.vertices[v]);
        }
        v = copied[v];
      }
      pieces[i].triangles.push_back(t);
    }
  }
  return pieces;
}

}  // namespace tegotae
