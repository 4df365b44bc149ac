#include "experiments/peg_task.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numbers.hpp"
#include "experiments/statistics.hpp"
#include "models/shapes.hpp"
#include "peg_in_hole/peg_scene.hpp"
#include "tegotae/import/load.hpp"

namespace tegotae::experiments {
namespace {

const shapes::Block kBlock;
const shapes::Peg kPeg;

// How long an operator may take to the surface, s.
constexpr double kReach = 6;
// Above the bottom (m) where the tip counts as there.
constexpr double kBottom = 0.5e-3;
// Ticks between two looks at how deep the parts are in each other, and poses asked of FCL.
constexpr std::size_t kDepthEvery = 10, kFclPoses = 60;
constexpr double kVibrationHz = 30;
constexpr double kChamfer = 0.001;                   // m
constexpr double kMaxTilt = 5 * 0.0174532925199433;  // rad

std::shared_ptr<const TriangleMesh> shared(TriangleMesh mesh) {
  return std::make_shared<const TriangleMesh>(weld(mesh));
}

}  // namespace

PegTask::PegTask(double ratio, const std::string& resolver, int segments) {
  shapes::Block block = kBlock;
  shapes::Peg peg = kPeg;
  block.segments = peg.segments = segments > 0 ? segments : apps::facets(ratio);
  peg.diameter = ratio * block.hole_diameter;
  scene_.parts.push_back({"hole", shared(shapes::block_with_hole(block)), Pose{}, false});
  scene_.parts.push_back({"peg", shared(shapes::peg(peg)), Pose{Quat::Identity(), {0, 0, 0.05}}, true});
  scene_.contact.resolver = resolver_kind(resolver);

  for (int i = 0; i < block.segments; ++i) {
    const double angle = 2 * kPi * (i + 0.5) / block.segments;
    facet_normals_.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  const TriangleMesh& peg_mesh = *scene_.parts[1].mesh;
  for (const auto& [a, b, c] : peg_mesh.triangles) {
    const Vec3 &A = peg_mesh.vertices[a], &B = peg_mesh.vertices[b], &C = peg_mesh.vertices[c];
    const Vec3 n = (B - A).cross(C - A).normalized();
    const Plane plane{n, n.dot(A)};
    const auto same = [&](const Plane& p) { return (p.n - n).norm() < 1e-6 && std::abs(p.d - plane.d) < 1e-9; };
    if (std::none_of(peg_planes_.begin(), peg_planes_.end(), same)) peg_planes_.push_back(plane);
  }
  peg_vertices_ = peg_mesh.vertices;
  // The hole's own vertices; the block's outline is out of reach.
  for (const Vec3& v : scene_.parts[0].mesh->vertices)
    if (v.head<2>().norm() < 0.5 * block.hole_diameter + 2 * block.chamfer) rim_vertices_.push_back(v);
}

Scene PegTask::scene_at(const Pose& start) const {
  Scene scene = scene_;
  scene.parts[1].pose = start;
  return scene;
}

InsertionTask PegTask::task() const {
  InsertionTask t;
  t.tip = tip();
  t.depth = depth();
  t.goal = {Quat::Identity(), Vec3(0, 0, -depth()) - t.tip};
  t.start = {Quat::Identity(), Vec3(0.02, -0.02, 0.03) - t.tip};
  return t;
}

InsertionTask PegTask::tilted_task(std::size_t person, int i, int n) const {
  InsertionTask out = task();
  const double share = static_cast<double>(i + 1) / n;
  const double a = 2.4 * i + 1.3 * static_cast<double>(person), b = 1.1 * i + 2.1 * static_cast<double>(person);
  out.own_errors = false;
  out.tilt = share * kMaxTilt * Vec3(std::cos(a), std::sin(a), 0);
  out.offset = share * kChamfer * Vec3(std::cos(b), std::sin(b), 0);
  return out;
}

Vec3 PegTask::tip() const {
  return {0, 0, -kPeg.length / 2};
}
double PegTask::depth() const {
  return kBlock.depth;
}

double PegTask::penetration(const Pose& X) const {
  return std::max(peg_vertices_in_block(X), block_vertices_in_peg(X));
}

double PegTask::peg_vertices_in_block(const Pose& X) const {
  double deepest = 0;
  const double radius = kBlock.hole_diameter / 2, half = std::sqrt(0.5);
  for (const Vec3& v : peg_vertices_) {
    const Vec3 p = X * v;
    if (p.z() >= 0) continue;
    double out = -std::numeric_limits<double>::infinity();
    for (const Vec3& n : facet_normals_) out = std::max(out, n.dot(p));
    // Into the wall, the chamfer's cone and the top face: a point is in the block as deep as the nearest way out.
    double depth = std::min(-p.z(), std::max(out - radius, -kBlock.depth - p.z()));
    depth = std::min({depth, kBlock.size.x() / 2 - std::abs(p.x()), kBlock.size.y() / 2 - std::abs(p.y())});
    if (p.z() > -kBlock.chamfer) depth = std::min(depth, half * (out - radius - kBlock.chamfer - p.z()));
    deepest = std::max(deepest, depth);
  }
  return deepest;
}

double PegTask::block_vertices_in_peg(const Pose& X) const {
  double deepest = 0;
  const Pose X_inverse = X.inverse();
  for (const Vec3& v : rim_vertices_) {
    const Vec3 p = X_inverse * v;
    double inside = std::numeric_limits<double>::infinity();
    for (const Plane& plane : peg_planes_) {
      inside = std::min(inside, plane.d - plane.n.dot(p));
      if (inside <= deepest) break;
    }
    deepest = std::max(deepest, inside);
  }
  return deepest;
}

Attempt attempt(const PegTask& peg, const OperatorProfile& profile, const InsertionTask& task, std::uint64_t seed,
                double seconds, bool to_surface) {
  Operator op(profile, task, seed);
  const Scene scene = peg.scene_at(op.start());
  SimulatedDeviceSettings pen;
  pen.hand = profile.hand;
  double at_surface = kNan;
  Attempt a;
  a.time = a.time_to_bottom = kNan;
  std::size_t touched = 0, n = 0;
  a.samples = run_trial(scene, pen, op, &op, kReach + seconds, [&](const Sample& s) {
    const double tip = (s.X * peg.tip()).z();
    if (std::isnan(at_surface) && tip <= 0) {
      at_surface = s.t;
      touched = n;
    }
    if (n++ % kDepthEvery == 0) a.penetration = std::max(a.penetration, peg.penetration(s.X));
    if (!a.reached && s.center.z() <= 0) {
      a.reached = true;
      a.time = s.t - at_surface;
    }
    if (tip <= -peg.depth() + kBottom) {
      a.completed = true;
      a.time_to_bottom = s.t - at_surface;
    }
    return a.completed || (to_surface && a.reached) || s.t - at_surface > seconds;
  });
  std::vector<Vec3> center, force;
  for (std::size_t i = touched; i < a.samples.size(); ++i) {
    center.push_back(a.samples[i].center);
    force.push_back(a.samples[i].wrench.force);
  }
  if (std::isnan(at_surface)) return a;
  a.vibration = rms_above(center, 1e-3, kVibrationHz);
  a.force_vibration = rms_above(force, 1e-3, kVibrationHz);
  a.intersecting = count_intersecting(scene, a.samples, kFclPoses);
  a.held_back = a.samples.back().held_back;
  return a;
}

}  // namespace tegotae::experiments
