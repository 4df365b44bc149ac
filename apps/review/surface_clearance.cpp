#include "review/surface_clearance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <unordered_map>

#include "broadphase/bounding_spheres.hpp"
#include "core/parallel_for.hpp"
#include "feature/point_course.hpp"
#include "feature/signed_distance.hpp"
#include "loop/scene_parts.hpp"
#include "narrowphase/patch_cache.hpp"
#include "view/display_mesh.hpp"

namespace tegotae::review {
namespace {

// Triangles are cut until no edge is longer than this share of the part's radius, or a coarser one for many.
constexpr double kEdgeShare = 1.0 / 8;
constexpr double kCoarser = 1.3;
constexpr std::size_t kBlock = 64;  // points that a thread takes at a time

struct Refined {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Cuts every edge longer than `longest` in its middle, once; false when there is none.
bool refine(Refined& mesh, double longest) {
  std::unordered_map<std::uint64_t, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) -> std::uint32_t {
    if ((mesh.points[a] - mesh.points[b]).norm() <= longest) return std::numeric_limits<std::uint32_t>::max();
    const auto [at, fresh] = middles.try_emplace(std::uint64_t{std::min(a, b)} << 32 | std::max(a, b),
                                                 static_cast<std::uint32_t>(mesh.points.size()));
    if (fresh) mesh.points.push_back(0.5 * (mesh.points[a] + mesh.points[b]));
    return at->second;
  };
  std::vector<std::array<std::uint32_t, 3>> out;
  constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  for (auto t : mesh.triangles) {
    std::array<std::uint32_t, 3> m = {middle(t[0], t[1]), middle(t[1], t[2]), middle(t[2], t[0])};
    // Turn the corners until a cut edge comes first, and with two of them the uncut one last.
    for (int turn = 0; turn < 2 && (m[0] == none || (m[2] != none && m[1] == none)); ++turn) {
      t = {t[1], t[2], t[0]};
      m = {m[1], m[2], m[0]};
    }
    if (m[0] == none) {
      out.push_back(t);
    } else if (m[1] == none) {
      out.push_back({t[0], m[0], t[2]});
      out.push_back({m[0], t[1], t[2]});
    } else {
      out.push_back({m[0], t[1], m[1]});
      if (m[2] == none) {
        out.push_back({t[0], m[0], m[1]});
        out.push_back({t[0], m[1], t[2]});
      } else {
        out.push_back({t[0], m[0], m[2]});
        out.push_back({m[0], m[1], m[2]});
        out.push_back({m[2], m[1], t[2]});
      }
    }
  }
  mesh.triangles = std::move(out);
  return !middles.empty();
}

SignedDistance distance_to(const std::shared_ptr<const TriangleMesh>& mesh) {
  return SignedDistance(std::make_shared<Surface>(mesh), cached_patch_tree(mesh));
}

/// Finds how near points come to other parts along a path.
class PathClearance {
 public:
  PathClearance(const Scene& scene, const std::vector<RecordFrame>& rows, const std::vector<std::size_t>& numbers,
                double reach)
      : reach_(reach) {
    const Sphere ball = bounding_sphere(*held_part(scene).mesh);
    BoundingSpheres spheres;
    std::vector<const Part*> others;
    for (const Part& part : scene.parts) {
      if (part.held) continue;
      spheres.add(bounding_sphere(*part.mesh), part.pose);
      others.push_back(&part);
    }
    std::vector<std::uint32_t> near;
    std::vector<bool> ever(others.size());
    for (const std::size_t i : numbers) {
      const Pose& X = rows[i].x;
      if (!poses_.empty() && X.p == poses_.back().p && X.q.coeffs() == poses_.back().q.coeffs()) continue;
      poses_.push_back(X);
      spheres.query(X * ball.center, ball.radius, reach, near);
      for (const std::uint32_t k : near) ever[k] = true;
    }
    for (std::size_t k = 0; k < others.size(); ++k)
      if (ever[k]) others_.push_back({cached_patch_tree(others[k]->mesh), others[k]->pose.inverse()});
  }

  /// What a thread knows from the point before.
  struct Followed {
    PointCourse course;
    NearPlace last{0, 0, kNone, 0};
  };

  /// The least distance of the point (held part's file frame) to another part over the path, at most the reach.
  double least(const Vec3& point, Followed& followed) const {
    PointCourse& course = followed.course;
    course.places().clear();
    for (const Pose& X : poses_) course.places().push_back(X * point);
    course.build();
    NearPlace best{reach_, 0, kNone, 0};
    // A neighbor came nearest at about the same place.
    if (const NearPlace& last = followed.last; last.surface != kNone) {
      const Other& other = others_[last.surface];
      if (course.nearer_there(*other.tree, other.X_FW, last.place, last.face, best)) best.surface = last.surface;
    }
    for (std::uint32_t k = 0; k < others_.size(); ++k)
      if (course.nearer(*others_[k].tree, others_[k].X_FW, best)) best.surface = k;
    followed.last = best;
    return best.distance;
  }

 private:
  struct Other {
    std::shared_ptr<const PatchTree> tree;
    Pose X_FW;  ///< W in its file frame
  };

  double reach_;
  std::vector<Pose> poses_;  ///< without those in which it stays
  std::vector<Other> others_;
};

}  // namespace

ColoredSurface sampled_surface(const std::shared_ptr<const TriangleMesh>& mesh, std::size_t most) {
  const view::DisplayMesh shown = view::display_mesh(*mesh, most);
  Refined whole;
  for (std::size_t i = 0; i < shown.positions.size(); i += 3)
    whole.points.emplace_back(shown.positions[i], shown.positions[i + 1], shown.positions[i + 2]);
  for (std::size_t i = 0; i < shown.indices.size(); i += 3)
    whole.triangles.push_back({shown.indices[i], shown.indices[i + 1], shown.indices[i + 2]});
  Refined fine = whole;
  for (double edge = kEdgeShare * bounding_sphere(*mesh).radius;; edge *= kCoarser) {
    fine = whole;
    while (fine.triangles.size() <= most && refine(fine, edge)) {
    }
    if (fine.triangles.size() <= most) break;
  }
  // A mesh drawn together has vertices beside its surface.
  if (shown.indices.size() / 3 < mesh->triangles.size()) {
    const SignedDistance distance = distance_to(mesh);
    std::uint32_t hint = 0;
    for (Vec3& p : fine.points) {
      const SurfacePoint s = distance.at(p, hint);
      hint = s.face;
      p = s.point;
    }
  }
  ColoredSurface out;
  for (const Vec3& p : fine.points)
    for (const double x : p) out.positions.push_back(static_cast<float>(x));
  for (const auto& t : fine.triangles) out.indices.insert(out.indices.end(), t.begin(), t.end());
  return out;
}

void add_clearance(const Scene& scene, const std::vector<RecordFrame>& rows, const std::vector<std::size_t>& looked_at,
                   double reach, const Progress& progress, ColoredSurface& surface) {
  const std::size_t count = surface.positions.size() / 3;
  surface.reach = reach;
  surface.clearance.resize(count);
  const PathClearance path(scene, rows, looked_at, reach);
  const auto blocks = static_cast<int>((count + kBlock - 1) / kBlock);
  const auto color = [&](int block) {
    PathClearance::Followed followed;
    const std::size_t begin = static_cast<std::size_t>(block) * kBlock;
    for (std::size_t i = begin; i < std::min(begin + kBlock, count); ++i) {
      const float* p = surface.positions.data() + 3 * i;
      surface.clearance[i] = static_cast<float>(path.least(Vec3(p[0], p[1], p[2]), followed));
    }
  };
  parallel_for(blocks, 0, color, [&](int done) {
    if (progress) progress("clearance of the surface, point", static_cast<std::size_t>(done) * kBlock, count);
  });
}

}  // namespace tegotae::review
