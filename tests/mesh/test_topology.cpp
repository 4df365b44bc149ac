#include <cmath>
#include <map>
#include <random>
#include <set>

#include "catch.hpp"
#include "mesh/t_junctions.hpp"
#include "mesh/topology.hpp"
#include "models/shapes.hpp"
#include "tegotae/core/constants.hpp"
#include "tegotae/import/load.hpp"
#include "tegotae/mesh/report.hpp"

using namespace tegotae;

namespace {

TriangleMesh mesh_of(std::vector<Vec3> vertices, std::vector<std::array<std::uint32_t, 3>> triangles) {
  return {"test", std::move(vertices), std::move(triangles)};
}

/// The kind of the edge between the vertices a and b.
EdgeKind kind(const Topology& t, std::uint32_t a, std::uint32_t b) {
  for (const auto& e : t.edges) {
    if (std::minmax(e.v[0], e.v[1]) == std::minmax(a, b)) return e.kind;
  }
  FAIL("no such edge");
  return EdgeKind::boundary;
}

bool collapsed(const std::array<std::uint32_t, 3>& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

/// Everything the header promises about links, by plain means.
void require_consistent(const TriangleMesh& mesh, const Topology& topology) {
  const std::size_t F = mesh.triangles.size(), V = mesh.vertices.size();
  REQUIRE(topology.twin.size() == 3 * F);
  REQUIRE(topology.face_edges.size() == F);
  REQUIRE(topology.face_normals.size() == F);
  REQUIRE(topology.vertex_face_begin.size() == V + 1);
  REQUIRE(topology.vertex_edge_begin.size() == V + 1);
  REQUIRE(topology.vertex_flat.size() == V);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> users;
  std::vector<std::multiset<std::uint32_t>> faces(V), edges(V);
  for (std::uint32_t h = 0; h < 3 * F; ++h) {
    const auto& t = mesh.triangles[h / 3];
    if (collapsed(t)) {
      REQUIRE(topology.twin[h] == kNone);
      REQUIRE(topology.face_edges[h / 3][h % 3] == kNone);
      continue;
    }
    faces[t[h % 3]].insert(h / 3);
    users[std::minmax(t[h % 3], t[(h % 3 + 1) % 3])].push_back(h);
  }
  REQUIRE(topology.edges.size() == users.size());
  for (const auto& [ends, hs] : users) {
    const std::uint32_t id = topology.face_edges[hs[0] / 3][hs[0] % 3];
    REQUIRE(id < topology.edges.size());
    const Topology::Edge& e = topology.edges[id];
    REQUIRE(std::minmax(e.v[0], e.v[1]) == std::minmax(ends.first, ends.second));
    edges[ends.first].insert(id);
    edges[ends.second].insert(id);
    REQUIRE(e.f[0] == hs[0] / 3);
    REQUIRE(e.v[0] == mesh.triangles[hs[0] / 3][hs[0] % 3]);
    REQUIRE(e.f[1] == (hs.size() > 1 ? hs[1] / 3 : kNone));
    REQUIRE((e.kind == EdgeKind::boundary) == (hs.size() == 1));
    const bool opposed = hs.size() == 2 && mesh.triangles[hs[1] / 3][hs[1] % 3] == e.v[1];
    for (const std::uint32_t h : hs) {
      REQUIRE(topology.face_edges[h / 3][h % 3] == id);
      REQUIRE(topology.twin[h] == (opposed ? hs[0] + hs[1] - h : kNone));
    }
    if (hs.size() > 1 && !opposed) REQUIRE(e.kind == EdgeKind::non_manifold);
  }
  for (std::size_t v = 0; v < V; ++v) {
    const auto list = [v](const auto& begin, const auto& items) {
      return std::multiset<std::uint32_t>(items.begin() + begin[v], items.begin() + begin[v + 1]);
    };
    REQUIRE(list(topology.vertex_face_begin, topology.vertex_faces) == faces[v]);
    REQUIRE(list(topology.vertex_edge_begin, topology.vertex_edges) == edges[v]);
  }
}

}  // namespace

TEST_CASE("links of shapes and of random surfaces hold together", "[topology]") {
  for (const TriangleMesh& mesh : {shapes::box({1, 2, 3}, {2, 3, 4}), shapes::block_with_hole({}), shapes::peg({}),
                                   shapes::torus_knot({}), TriangleMesh{}}) {
    require_consistent(mesh, build_topology(mesh));
  }
  // Random triples of few vertices: collapsed, duplicate, many-fold and turned faces galore.
  std::mt19937 rng(9);
  for (int round = 0; round < 200; ++round) {
    TriangleMesh mesh;
    std::uniform_real_distribution<double> u(-1, 1);
    const auto n = static_cast<std::uint32_t>(4 + rng() % 12);
    for (std::uint32_t i = 0; i < n; ++i) mesh.vertices.push_back({u(rng), u(rng), u(rng)});
    for (int f = 0; f < 30; ++f) {
      const auto pick = [&] { return static_cast<std::uint32_t>(rng() % n); };
      mesh.triangles.push_back({pick(), pick(), pick()});
    }
    require_consistent(mesh, build_topology(mesh));
  }
}

TEST_CASE("edges of a divided box are convex at its rims and flat elsewhere", "[topology]") {
  const Vec3 size(1, 2, 3);
  const TriangleMesh mesh = shapes::box(size, {3, 3, 3});
  const Topology t = build_topology(mesh);
  const auto sides_of = [&](const Vec3& p) {
    return (p.cwiseAbs() - size / 2).cwiseAbs().unaryExpr([](double d) { return d < 1e-12 ? 1.0 : 0.0; });
  };
  for (const auto& e : t.edges) {
    // On a rim, both ends lie on the same two sides of the box.
    const Vec3 common = sides_of(mesh.vertices[e.v[0]]).cwiseProduct(sides_of(mesh.vertices[e.v[1]]));
    const Vec3 middle = sides_of(0.5 * (mesh.vertices[e.v[0]] + mesh.vertices[e.v[1]]));
    const bool rim = common.sum() >= 2 && middle.sum() >= 2;
    REQUIRE(e.kind == (rim ? EdgeKind::convex : EdgeKind::flat));
  }
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    REQUIRE((t.vertex_flat[v] != 0) == (sides_of(mesh.vertices[v]).sum() == 1));
  }
  for (std::size_t f = 0; f < t.face_normals.size(); ++f) {
    REQUIRE(t.face_normals[f].norm() == Approx(1).epsilon(1e-14));
    REQUIRE(t.face_normals[f].dot(mesh.vertices[mesh.triangles[f][0]]) > 0);
  }
}

TEST_CASE("a hole is concave where it bends inward and convex at its rims", "[topology]") {
  shapes::Block b;
  const TriangleMesh mesh = shapes::block_with_hole(b);
  const Topology t = build_topology(mesh);
  const double corner = b.hole_diameter / 2 / std::cos(std::acos(-1.0) / b.segments);
  int upright = 0, floor = 0, rim = 0;
  for (const auto& e : t.edges) {
    const Vec3 &p = mesh.vertices[e.v[0]], &q = mesh.vertices[e.v[1]];
    if (std::abs(p.head<2>().norm() - corner) > 1e-9 || std::abs(q.head<2>().norm() - corner) > 1e-9) continue;
    if ((p - q).head<2>().norm() < 1e-9) {
      REQUIRE(e.kind == EdgeKind::concave);
      ++upright;
    } else if (std::abs(p.z() - q.z()) < 1e-12 && std::abs(p.z() + b.depth) < 1e-12) {
      REQUIRE(e.kind == EdgeKind::concave);
      ++floor;
    } else if (std::abs(p.z() - q.z()) < 1e-12 && std::abs(p.z() + b.chamfer) < 1e-12) {
      REQUIRE(e.kind == EdgeKind::convex);
      ++rim;
    } else {
      REQUIRE(e.kind == EdgeKind::flat);
    }
  }
  REQUIRE(upright == b.segments * b.rings);
  REQUIRE(floor == b.segments);
  REQUIRE(rim == b.segments);
}

TEST_CASE("the flat angle decides between flat, convex and concave", "[topology]") {
  for (const double angle :
       {-0.5, -1.1 * kFlatAngle, -0.9 * kFlatAngle, 0.0, 0.9 * kFlatAngle, 1.1 * kFlatAngle, 3.0}) {
    // Two triangles over the x axis; a positive angle bends the second one down, away from the viewer above.
    const TriangleMesh mesh =
        mesh_of({{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, -std::cos(angle), -std::sin(angle)}}, {{0, 1, 2}, {1, 0, 3}});
    const EdgeKind expected = std::abs(angle) < kFlatAngle ? EdgeKind::flat
                              : angle > 0                  ? EdgeKind::convex
                                                           : EdgeKind::concave;
    REQUIRE(kind(build_topology(mesh), 0, 1) == expected);
  }
}

TEST_CASE("slivers make no creases", "[topology]") {
  // A square with a T-junction closed by a face of no area: 4 lies on the diagonal 0-2.
  std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0}};
  const std::vector<std::array<std::uint32_t, 3>> faces = {{0, 1, 4}, {1, 2, 4}, {0, 2, 3}, {0, 4, 2}};
  for (const double off : {0.0, 1e-8, -1e-8}) {  // with rounding that tips the sliver's own normal anywhere
    corners[4].z() = off;
    corners[4].x() = 0.5 + off;
    const Topology t = build_topology(mesh_of(corners, faces));
    REQUIRE(kind(t, 0, 2) == EdgeKind::flat);
    REQUIRE(kind(t, 0, 4) == EdgeKind::flat);
    REQUIRE(kind(t, 4, 2) == EdgeKind::flat);
    REQUIRE((t.face_normals[3] - Vec3::UnitZ()).norm() < 1e-6);
  }
  // The same seam along a true ridge: the ridge is on the sliver's short sides.
  corners[4] = {0.5, 0.5, 0};
  corners[3] = {0, 1, -1};
  const Topology ridge = build_topology(mesh_of(corners, faces));
  REQUIRE(kind(ridge, 0, 2) == EdgeKind::flat);
  REQUIRE(kind(ridge, 0, 4) == EdgeKind::convex);
  REQUIRE(kind(ridge, 4, 2) == EdgeKind::convex);

  // With no one to lend a normal, an edge promises nothing.
  const Topology alone =
      build_topology(mesh_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0.5, 1, 0}}, {{0, 1, 2}, {1, 0, 3}}));
  REQUIRE(alone.face_normals[0].isZero(0));
  REQUIRE(kind(alone, 0, 1) == EdgeKind::non_manifold);
}

TEST_CASE("T-junctions are counted, and nothing else is one", "[topology]") {
  CHECK(count_t_junctions(shapes::box({1, 1, 1})) == 0);
  TriangleMesh open = shapes::box({1, 1, 1});
  open.triangles.pop_back();
  CHECK(count_t_junctions(open) == 0);

  // Faces of a sphere, no two of them neighbors, are cut in two at a point of one side: the face beyond is not.
  TriangleMesh cut = shapes::sphere(0.04, 48, 24);
  std::mt19937 random(20);
  std::uniform_real_distribution<double> share(0.1, 0.9);
  const Topology topology = build_topology(cut);
  std::vector<bool> taken(cut.triangles.size(), false);
  std::size_t cuts = 0;
  for (std::uint32_t f = 0; f < topology.face_edges.size(); ++f) {
    const std::uint32_t beyond = topology.twin[3 * f] / 3;
    if (random() % 8 != 0 || taken[f] || taken[beyond]) continue;
    taken[f] = taken[beyond] = true;
    const auto [a, b, c] = cut.triangles[f];
    const double s = share(random);
    const Vec3 exact = (1 - s) * cut.vertices[a] + s * cut.vertices[b];
    const auto m = static_cast<std::uint32_t>(cut.vertices.size());
    cut.vertices.push_back(exact.cast<float>().cast<double>());
    cut.triangles[f] = {a, m, c};
    cut.triangles.push_back({m, b, c});
    ++cuts;
  }
  REQUIRE(cuts > 100);
  CHECK(count_t_junctions(cut) == cuts);
  CHECK(report(cut).boundary_edges == 3 * cuts);
  // Beside the edge by more than rounding it is a hole.
  for (std::size_t i = cut.vertices.size() - cuts; i < cut.vertices.size(); ++i) cut.vertices[i] *= 1.0001;
  CHECK(count_t_junctions(cut) == 0);
}

TEST_CASE("collapsed faces leave their neighbors linked", "[topology]") {
  TriangleMesh mesh = shapes::box({1, 1, 1});
  mesh.triangles.insert(mesh.triangles.begin() + 3, {0, 1, 1});
  mesh.triangles.push_back({2, 2, 2});
  require_consistent(mesh, build_topology(mesh));
  const MeshReport r = report(mesh);
  REQUIRE(r.closed);
  REQUIRE(r.degenerate_faces == 2);
  REQUIRE(r.components == 1);
}

TEST_CASE("reports of open, turned, duplicate and many-fold surfaces", "[topology]") {
  TriangleMesh box = shapes::box({1, 2, 3});
  REQUIRE(report(box).box_max == Vec3(0.5, 1, 1.5));
  REQUIRE(report(box).box_min == Vec3(-0.5, -1, -1.5));

  TriangleMesh open = box;
  open.triangles.pop_back();
  REQUIRE(report(open).boundary_edges == 3);
  REQUIRE(!report(open).closed);

  TriangleMesh turned = box;
  std::swap(turned.triangles[5][0], turned.triangles[5][1]);
  REQUIRE(report(turned).non_manifold_edges == 3);
  REQUIRE(report(turned).boundary_edges == 0);
  REQUIRE(!report(turned).closed);

  TriangleMesh twice = box;
  twice.triangles.push_back({box.triangles[0][1], box.triangles[0][2], box.triangles[0][0]});
  twice.triangles.push_back({box.triangles[1][1], box.triangles[1][0], box.triangles[1][2]});
  REQUIRE(report(twice).duplicate_faces == 2);
  REQUIRE(!report(twice).closed);

  REQUIRE(!report(TriangleMesh{}).closed);
}

TEST_CASE("shells that look the wrong way are counted", "[topology]") {
  // A box of 6, in it one of 4, in that one of 2, and one of 1 beside all.
  const auto shells = [](std::array<bool, 4> turned) {
    TriangleMesh all;
    const Vec3 sizes[] = {Vec3::Constant(6), Vec3::Constant(4), Vec3::Constant(2), Vec3::Constant(1)};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto base = static_cast<std::uint32_t>(all.vertices.size());
      const TriangleMesh box =
          shapes::moved(shapes::box(sizes[i]), {i == 3 ? 10.0 : 0.1 * static_cast<double>(i), 0, 0});
      all.vertices.insert(all.vertices.end(), box.vertices.begin(), box.vertices.end());
      for (auto t : box.triangles) {
        if (turned[i]) std::swap(t[1], t[2]);
        all.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
      }
    }
    const MeshReport r = report(all);
    REQUIRE(r.closed);
    return r.inverted_shells;
  };
  REQUIRE(shells({false, true, false, false}) == 0);  // a wall, its cavity, a core in it
  REQUIRE(shells({false, false, false, false}) == 1);
  REQUIRE(shells({true, false, true, true}) == 4);
  REQUIRE(shells({false, true, true, false}) == 1);
  REQUIRE(shells({false, true, false, true}) == 1);
}

TEST_CASE("of a mesh that is not closed, its closed shells are judged", "[topology]") {
  // Boxes of these sizes and places, some inside out, some without a face.
  struct Shell {
    double size;
    Vec3 at;
    bool turned, open;
  };
  const auto inverted = [](const std::vector<Shell>& shells) {
    TriangleMesh all;
    bool closed = true;
    for (const Shell& shell : shells) {
      const auto base = static_cast<std::uint32_t>(all.vertices.size());
      TriangleMesh box = shapes::moved(shapes::box(Vec3::Constant(shell.size)), shell.at);
      if (shell.open) box.triangles.pop_back();
      closed = closed && !shell.open;
      all.vertices.insert(all.vertices.end(), box.vertices.begin(), box.vertices.end());
      for (auto t : box.triangles) {
        if (shell.turned) std::swap(t[1], t[2]);
        all.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
      }
    }
    const MeshReport r = report(all);
    REQUIRE(r.closed == closed);
    REQUIRE(r.components == shells.size());
    return r.inverted_shells;
  };
  const Vec3 here = Vec3::Zero(), beside(20, 0, 0), farther(40, 0, 0);
  REQUIRE(inverted({{1, here, false, false}, {1, beside, false, true}}) == 0);
  REQUIRE(inverted({{1, here, true, false}, {1, beside, false, true}}) == 1);
  REQUIRE(inverted({{1, here, true, false}, {1, beside, true, true}}) == 1);  // an open one has no outside
  REQUIRE(inverted({{1, here, true, false}, {1, beside, true, false}, {1, farther, false, true}}) == 2);
  // A wall with its cavity, and an open shell elsewhere.
  REQUIRE(inverted({{4, here, false, false}, {2, here, true, false}, {1, beside, false, true}}) == 0);
  REQUIRE(inverted({{4, here, false, false}, {2, here, false, false}, {1, beside, false, true}}) == 1);
  // What an open shell surrounds may be its cavity, or a part in a box without a lid.
  REQUIRE(inverted({{4, here, false, true}, {2, here, true, false}}) == 0);
  REQUIRE(inverted({{4, here, false, true}, {2, here, false, false}}) == 0);
}

TEST_CASE("a vertex where two flat sheets touch is not flat", "[topology]") {
  // Two fans around vertex 0, in the planes z = 0 and x = 0.
  TriangleMesh mesh;
  mesh.vertices.push_back(Vec3::Zero());
  for (int plane = 0; plane < 2; ++plane) {
    for (std::uint32_t i = 0; i < 6; ++i) {
      const double a = std::acos(-1.0) / 3 * i, c = std::cos(a), s = std::sin(a);
      mesh.vertices.push_back(plane == 0 ? Vec3(c, s, 0) : Vec3(0, c, s));
      mesh.triangles.push_back({0, 6u * plane + 1 + i, 6u * plane + 1 + (i + 1) % 6});
    }
  }
  REQUIRE(build_topology(mesh).vertex_flat[0] == 0);
  mesh.triangles.resize(6);
  REQUIRE(build_topology(mesh).vertex_flat[0] == 1);
  REQUIRE(build_topology(mesh).vertex_flat[12] == 0);  // on no face
}
