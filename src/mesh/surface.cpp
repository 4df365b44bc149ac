#include "mesh/surface.hpp"

#include <algorithm>

#include "mesh/cache_entry.hpp"
#include "mesh/in_use.hpp"
#include "mesh/mesh_key.hpp"

namespace tegotae {
namespace {

// To be raised whenever Surface is built otherwise over the same mesh.
constexpr std::uint32_t kBuild = 1;

bool below(const std::vector<std::uint32_t>& numbers, std::size_t end, bool or_none) {
  return std::all_of(numbers.begin(), numbers.end(),
                     [=](std::uint32_t n) { return n < end || (or_none && n == kNone); });
}

/// Whether `begin` has the offsets of `groups` groups into a list of this length.
bool are_offsets(const std::vector<std::uint32_t>& begin, std::size_t groups, std::size_t length) {
  return begin.size() == groups + 1 && begin.front() == 0 && begin.back() == length &&
         std::is_sorted(begin.begin(), begin.end());
}

bool is_sound(const TriangleMesh& mesh, const Topology& t) {
  const std::size_t faces = mesh.triangles.size(), vertices = mesh.vertices.size(), edges = t.edges.size();
  const auto edge = [=](const Topology::Edge& e) {
    return e.v[0] < vertices && e.v[1] < vertices && e.f[0] < faces && (e.f[1] < faces || e.f[1] == kNone) &&
           e.kind <= EdgeKind::non_manifold;
  };
  const auto around = [=](const std::array<std::uint32_t, 3>& of) {
    return std::all_of(of.begin(), of.end(), [=](std::uint32_t e) { return e < edges || e == kNone; });
  };
  return t.twin.size() == 3 * faces && below(t.twin, 3 * faces, true) && t.face_edges.size() == faces &&
         t.face_normals.size() == faces && t.vertex_flat.size() == vertices &&
         std::all_of(t.edges.begin(), t.edges.end(), edge) &&
         std::all_of(t.face_edges.begin(), t.face_edges.end(), around) &&
         are_offsets(t.vertex_face_begin, vertices, t.vertex_faces.size()) && below(t.vertex_faces, faces, false) &&
         are_offsets(t.vertex_edge_begin, vertices, t.vertex_edges.size()) && below(t.vertex_edges, edges, false);
}

bool is_sound(const TriangleMesh& mesh, const FlatRegions& r) {
  return !r.corner_begin.empty() && r.of_face.size() == mesh.triangles.size() &&
         below(r.of_face, r.corner_begin.size() - 1, true) &&
         are_offsets(r.corner_begin, r.corner_begin.size() - 1, r.corners.size()) &&
         below(r.corners, mesh.vertices.size(), false);
}

std::shared_ptr<const Surface> load(const CacheName& name, const std::shared_ptr<const TriangleMesh>& mesh) {
  CacheReader entry(name);
  Topology t;
  FlatRegions r;
  const bool whole = entry.take(t.twin) && entry.take(t.edges) && entry.take(t.face_edges) &&
                     entry.take(t.face_normals) && entry.take(t.vertex_face_begin) && entry.take(t.vertex_faces) &&
                     entry.take(t.vertex_edge_begin) && entry.take(t.vertex_edges) && entry.take(t.vertex_flat) &&
                     entry.take(r.of_face) && entry.take(r.corner_begin) && entry.take(r.corners) && entry.done();
  if (!whole || !is_sound(*mesh, t) || !is_sound(*mesh, r)) return nullptr;
  return std::make_shared<const Surface>(mesh, std::move(t), std::move(r));
}

void store(const CacheName& name, const Surface& surface) {
  CacheWriter entry(name);
  const Topology& t = surface.topology;
  entry.put(t.twin);
  entry.put(t.edges);
  entry.put(t.face_edges);
  entry.put(t.face_normals);
  for (const auto* block : {&t.vertex_face_begin, &t.vertex_faces, &t.vertex_edge_begin, &t.vertex_edges})
    entry.put(*block);
  entry.put(t.vertex_flat);
  const FlatRegions& r = surface.regions;
  for (const auto* block : {&r.of_face, &r.corner_begin, &r.corners}) entry.put(*block);
  entry.keep();
}

}  // namespace

std::shared_ptr<const Surface> cached_surface(const std::shared_ptr<const TriangleMesh>& mesh) {
  static InUse<const TriangleMesh*, Surface> in_use;
  return in_use.get(mesh.get(), [&]() -> std::shared_ptr<const Surface> {
    if (!has_cache_folder() || mesh->triangles.size() < kMinCached) return std::make_shared<const Surface>(mesh);
    const CacheName name{"surface", kBuild, key_of(*mesh)};
    if (auto kept = load(name, mesh)) return kept;
    auto built = std::make_shared<const Surface>(mesh);
    store(name, *built);
    return built;
  });
}

}  // namespace tegotae
