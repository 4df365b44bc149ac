#include "bench/measure_fcl.hpp"

#include <algorithm>
#include <random>

#include "broadphase/bounding_spheres.hpp"
#include "narrowphase/fcl_narrow_phase.hpp"
#include "tegotae/core/clock.hpp"

namespace tegotae::bench {
namespace {

// More pairs than any query has.
constexpr int kAllContacts = 1'000'000'000;
// Queries before the clock counts: FCL's result allocates until it is warm.
constexpr std::size_t kWarmUp = 10;

std::vector<Pose> pressed(const BenchScene& scene, const Vec3& center, double radius, const LoopTrace& trace,
                          std::size_t most) {
  std::mt19937 rng(11);
  std::uniform_real_distribution<double> depth(0, scene.overlap);
  const std::size_t stride = std::max<std::size_t>(trace.X.size() / std::max<std::size_t>(most, 1), 1);
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < trace.X.size() && poses.size() < most; i += stride) {
    const Displacement d = displacement(trace.X[i], trace.Y[i], center);
    const double length = d.dp.norm() + radius * d.dr.norm();
    const double overlap = depth(rng);
    if (length > overlap) poses.push_back(displaced(trace.X[i], center, (overlap / length) * d));
  }
  return poses;
}

}  // namespace

FclFigures measure_fcl(const BenchScene& scene, const Vec3& center, const LoopTrace& trace, int most) {
  const Part* held = nullptr;
  std::vector<const TriangleMesh*> meshes;
  std::vector<Pose> poses_B;
  BoundingSpheres spheres;
  for (const Part& part : scene.scene.parts) {
    if (part.held) {
      held = &part;
      continue;
    }
    meshes.push_back(part.mesh.get());
    poses_B.push_back(part.pose.inverse());
    spheres.add(bounding_sphere(*part.mesh), part.pose);
  }
  FclNarrowPhase narrow(*held->mesh, meshes);
  const Sphere ball = bounding_sphere(*held->mesh);
  std::vector<Pose> poses = scene.jam_poses;
  if (poses.empty()) poses = pressed(scene, center, ball.radius, trace, static_cast<std::size_t>(most));

  FclFigures f;
  std::vector<std::int64_t> times;
  std::vector<std::uint32_t> near;
  std::vector<FacePair> pairs;
  const auto ask = [&](const Pose& X) {
    pairs.clear();
    spheres.query(X * ball.center, ball.radius, 0, near);
    for (const std::uint32_t i : near) narrow.intersections(i, poses_B[i] * X, kAllContacts, pairs);
  };
  on_measuring_thread([&] {
    Rest rest;
    for (std::size_t i = 0; i < std::min(kWarmUp, poses.size()); ++i) ask(poses[i]);
    for (const Pose& X : poses) {
      rest.pause_if_due();
      const std::int64_t start = monotonic_ns();
      ask(X);
      times.push_back(monotonic_ns() - start);
      f.pairs += static_cast<double>(pairs.size()) / static_cast<double>(poses.size());
      f.overlap += !pairs.empty();
    }
  });
  f.poses = poses.size();
  f.us = percentiles(times);
  return f;
}

}  // namespace tegotae::bench
