#include "tegotae/loop/clash.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <tuple>

#include "feature/signed_distance.hpp"
#include "feature/simplex_distance.hpp"
#include "mesh/components.hpp"
#include "narrowphase/fcl_pairs.hpp"
#include "narrowphase/patch_cache.hpp"
#include "narrowphase/patch_front.hpp"
#include "tegotae/mesh/report.hpp"

namespace tegotae {
namespace {

// Enough for all of them in practice; the deepest point is looked for near these and at every vertex.
constexpr std::size_t kMaxPairs = 1000000;
// For planes between patches of a pair, about 15 ms, before FCL is asked.
constexpr int kMaxClashSearches = 1 << 16;
// An edge that leans less than this out of a triangle's plane (sine) does not cross it: parts that lie face to face.
constexpr double kCrossing = 1e-9;

using Bounds = Eigen::AlignedBox3d;

/// What is known of a mesh, made when first needed.
struct MeshData {
  Bounds box;
  std::shared_ptr<const PatchTree> tree;
  std::unique_ptr<SignedDistance> distance;
  bool closed = false;                     ///< set with it
  std::vector<std::uint32_t> one_of_each;  ///< a vertex of each component
};

/// A part as seen from the file frame of another.
struct Side {
  const Part* part;
  MeshData* data;
};

struct Deepest {
  double depth = 0;
  Vec3 place = Vec3::Zero();  ///< file frame of the part that it lies in
};

/// Crossing of an edge: its number and where on it (0 to 1).
using Crossing = std::pair<std::uint32_t, double>;

class PairQuery {
 public:
  PairQuery(FclPairs& fcl, const ClashOptions& options) : fcl_(fcl), options_(options) {}

  /// Fills kind, gap, depth and place; false when the two are too far apart to be listed.
  bool query(const Side& a, const Side& b, Clash& clash) {
    const Pose X_BA = b.part->pose.inverse() * a.part->pose;
    const bool apart = known_apart(a, b, X_BA);
    std::vector<FclPairs::Faces> pairs;
    if (!apart) pairs = fcl_.intersections(*a.part->mesh, *b.part->mesh, X_BA, kMaxPairs);
    const bool inside = pairs.empty() && (any_inside(a, b) || any_inside(b, a));
    if (pairs.empty() && !inside) return !apart && query_apart(a, b, X_BA, clash);
    clash.gap = 0;
    clash.depth = 0;
    clash.triangle_pairs = pairs.size();
    if (!pairs.empty())
      clash.place_W =
          b.part->pose *
          closest_points(triangle(a, pairs.front().first, X_BA), triangle(b, pairs.front().second, Pose())).b;
    if (!closed(a) && !closed(b)) {
      clash.depth.reset();
      clash.kind = ClashKind::overlap;
      return true;
    }
    std::vector<Crossing> of_a, of_b;
    for (const auto& [face_a, face_b] : pairs) {
      add_crossings(a, face_a, X_BA, b, face_b, of_a);
      add_crossings(b, face_b, X_BA.inverse(), a, face_a, of_b);
    }
    take(deepest(a, b, of_a), b, clash);
    take(deepest(b, a, of_b), a, clash);
    clash.kind = clash.depth && *clash.depth > options_.tolerance ? ClashKind::overlap : ClashKind::touch;
    return true;
  }

 private:
  double reach() const { return std::max(options_.tolerance, options_.within); }

  /// Whether the certificate of the patches says that the surfaces are farther apart than `reach()`. FCL need not be
  /// asked then: its models of large meshes take seconds to build, and patches come from the cache.
  bool known_apart(const Side& a, const Side& b, const Pose& X_BA) {
    front_.attach(*tree(a), a.data->box.center(), *tree(b));
    front_.set_clearance(reach());
    WorkLimit limit;
    limit.searches = kMaxClashSearches;
    limit.blocking = 1;
    return front_.certify(X_BA, Displacement{}, limit).status == CertifyStatus::certified;
  }

  static const std::shared_ptr<const PatchTree>& tree(const Side& s) {
    if (!s.data->tree) s.data->tree = cached_patch_tree(s.part->mesh);
    return s.data->tree;
  }
  static SignedDistance& prepared(const Side& s) {
    if (!s.data->distance) {
      const auto& mesh = s.part->mesh;
      s.data->distance = std::make_unique<SignedDistance>(cached_surface(mesh), tree(s));
      s.data->closed = is_closed(s.data->distance->surface().topology);
    }
    return *s.data->distance;
  }
  static bool closed(const Side& s) {
    prepared(s);
    return s.data->closed;
  }
  static double signed_distance(const Side& s, const Vec3& p) { return prepared(s).at(p, 0).distance; }

  static void take(const Deepest& found, const Side& outer, Clash& clash) {
    if (found.depth <= clash.depth.value_or(0)) return;
    clash.depth = found.depth;
    clash.place_W = outer.part->pose * found.place;
  }

  /// Whether a component of `inner`, which crosses nothing of `outer`, lies inside of it.
  static bool any_inside(const Side& inner, const Side& outer) {
    const Pose X = outer.part->pose.inverse() * inner.part->pose;
    if (!outer.data->box.intersects(inner.data->box.transformed(Eigen::Translation3d(X.p) * X.q))) return false;
    std::vector<std::uint32_t>& starts = inner.data->one_of_each;
    if (starts.empty()) {
      const TriangleMesh& mesh = *inner.part->mesh;
      const Components parts = components(mesh, prepared(inner).surface().topology);
      starts.assign(parts.count, kNone);
      for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
        if (parts.of[f] != kNone) starts[parts.of[f]] = mesh.triangles[f][0];
    }
    if (!closed(outer)) return false;
    return std::any_of(starts.begin(), starts.end(), [&](std::uint32_t v) {
      const Vec3 p = X * inner.part->mesh->vertices[v];
      return outer.data->box.contains(p) && signed_distance(outer, p) < 0;
    });
  }

  bool query_apart(const Side& a, const Side& b, const Pose& X_BA, Clash& clash) {
    FclPairs::Faces nearest;
    // The bound itself is not found: look a little farther.
    const double bound = reach() * (1 + 1e-9) + 1e-12;
    clash.gap = fcl_.distance_below(bound, *a.part->mesh, *b.part->mesh, X_BA, nearest);
    if (!(clash.gap < bound)) return false;
    const ClosestPoints c = closest_points(triangle(a, nearest.first, X_BA), triangle(b, nearest.second, Pose()));
    clash.place_W = b.part->pose * (0.5 * (c.a + c.b));
    clash.kind = clash.gap <= options_.tolerance ? ClashKind::touch : ClashKind::near;
    return true;
  }

  static Simplex triangle(const Side& s, std::uint32_t face, const Pose& X) {
    const auto& t = s.part->mesh->triangles[face];
    const auto& v = s.part->mesh->vertices;
    return {3, {X * v[t[0]], X * v[t[1]], X * v[t[2]]}};
  }

  /// Where the edges of `face_a` cross the triangle `face_b`.
  static void add_crossings(const Side& a, std::uint32_t face_a, const Pose& X_BA, const Side& b, std::uint32_t face_b,
                            std::vector<Crossing>& crossings) {
    const Topology& topology = prepared(a).surface().topology;
    const Simplex t = triangle(b, face_b, Pose());
    const Vec3 e1 = t.p[1] - t.p[0], e2 = t.p[2] - t.p[0], n = e1.cross(e2);
    for (const std::uint32_t e : topology.face_edges[face_a]) {
      if (e == kNone) continue;
      const Vec3 from = X_BA * a.part->mesh->vertices[topology.edges[e].v[0]];
      const Vec3 way = X_BA * a.part->mesh->vertices[topology.edges[e].v[1]] - from;
      const double steep = n.dot(way);
      if (std::abs(steep) <= kCrossing * n.norm() * way.norm()) continue;
      const double s = n.dot(t.p[0] - from) / steep;
      if (!(s >= 0 && s <= 1)) continue;
      const Vec3 d = from + s * way - t.p[0];
      const double u = d.cross(e2).dot(n) / n.squaredNorm(), v = e1.cross(d).dot(n) / n.squaredNorm();
      // A hit on the rim of two triangles may count twice or, by rounding, not at all: take a little more.
      if (u >= -kCrossing && v >= -kCrossing && u + v <= 1 + kCrossing) crossings.emplace_back(e, s);
    }
  }

  /// The deepest of the points of `inner` that are looked at, in the frame of `outer`.
  static Deepest deepest(const Side& inner, const Side& outer, std::vector<Crossing>& crossings) {
    Deepest best;
    if (!closed(outer)) return best;
    const Pose X = outer.part->pose.inverse() * inner.part->pose;
    const auto visit = [&](const Vec3& p) {
      if (!outer.data->box.contains(p)) return;
      const double depth = -signed_distance(outer, p);
      if (depth > best.depth) best = {depth, p};
    };
    for (const Vec3& v : inner.part->mesh->vertices) visit(X * v);
    std::sort(crossings.begin(), crossings.end());
    const auto& edges = prepared(inner).surface().topology.edges;
    for (std::size_t i = 0; i < crossings.size(); ++i) {
      const auto [e, s] = crossings[i];
      const bool first = i == 0 || crossings[i - 1].first != e;
      const bool last = i + 1 == crossings.size() || crossings[i + 1].first != e;
      const Vec3 from = X * inner.part->mesh->vertices[edges[e].v[0]];
      const Vec3 way = X * inner.part->mesh->vertices[edges[e].v[1]] - from;
      if (first) visit(from + 0.5 * s * way);
      visit(from + 0.5 * (s + (last ? 1.0 : crossings[i + 1].second)) * way);
    }
    return best;
  }

  FclPairs& fcl_;
  const ClashOptions& options_;
  PatchFront front_;
};

/// Pairs of parts whose boxes come within `reach`.
std::vector<std::pair<std::size_t, std::size_t>> near_pairs(const std::vector<Bounds>& boxes, double reach) {
  std::vector<std::size_t> order(boxes.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return boxes[i].min().x() < boxes[j].min().x(); });
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < order.size(); ++i) {
    Bounds wide = boxes[order[i]];
    wide.min().array() -= reach;
    wide.max().array() += reach;
    for (std::size_t j = i + 1; j < order.size() && boxes[order[j]].min().x() <= wide.max().x(); ++j)
      if (wide.intersects(boxes[order[j]]))
        pairs.emplace_back(std::min(order[i], order[j]), std::max(order[i], order[j]));
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace

std::vector<Clash> find_clashes(const Scene& scene, const ClashOptions& options) {
  std::map<const TriangleMesh*, MeshData> data;
  std::vector<Bounds> boxes;
  for (const Part& part : scene.parts) {
    Bounds& box = data[part.mesh.get()].box;
    if (box.isEmpty())
      for (const Vec3& p : part.mesh->vertices) box.extend(p);
    boxes.push_back(box.transformed(Eigen::Translation3d(part.pose.p) * part.pose.q));
  }
  auto pairs = near_pairs(boxes, std::max(options.tolerance, options.within));
  if (options.held_only) {
    const auto of_others = [&](const auto& p) { return !scene.parts[p.first].held && !scene.parts[p.second].held; };
    pairs.erase(std::remove_if(pairs.begin(), pairs.end(), of_others), pairs.end());
  }
  FclPairs fcl;
  PairQuery pair_query(fcl, options);
  std::vector<Clash> clashes;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (options.progress) options.progress(i, pairs.size());
    Clash clash;
    std::tie(clash.a, clash.b) = pairs[i];
    const Part &a = scene.parts[clash.a], &b = scene.parts[clash.b];
    if (pair_query.query({&a, &data[a.mesh.get()]}, {&b, &data[b.mesh.get()]}, clash)) clashes.push_back(clash);
  }
  std::stable_sort(clashes.begin(), clashes.end(), [](const Clash& x, const Clash& y) {
    const double depth_x = x.depth.value_or(0), depth_y = y.depth.value_or(0);
    return std::tuple(x.kind, -depth_x, x.gap) < std::tuple(y.kind, -depth_y, y.gap);
  });
  return clashes;
}

}  // namespace tegotae
