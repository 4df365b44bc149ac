#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "broadphase/bounding_spheres.hpp"
#include "narrowphase/fcl_near_triangles.hpp"
#include "tegotae/loop/initial_contacts.hpp"
#include "tegotae/loop/scene.hpp"

namespace tegotae {

/// The parts of a scene for those who judge poses of its held part. Any thread may use it.
class JudgedScene {
 public:
  /// Pairs of `start` do not count until they have come free. Keeps a reference to `scene`.
  explicit JudgedScene(const Scene& scene, const InitialContactReport& start = {});
  /// Tells which pairs have come free by now.
  void came_free(const InitialContactReport& start) noexcept;

 private:
  friend class PoseJudge;
  const Part& held_;
  Sphere ball_;
  std::vector<const Part*> fixed_;
  std::vector<std::size_t> number_;                // of each fixed part, in the scene
  std::vector<std::atomic<std::uint32_t>> freed_;  // of each fixed part: InitialContact::freed
  BoundingSpheres spheres_;
};

/// Asks FCL about poses of a scene's held part, independently of the loop that committed them. For one thread.
class PoseJudge {
 public:
  /// Keeps a reference to `scene`.
  explicit PoseJudge(const JudgedScene& scene) : scene_(scene), pairs_(scene.fixed_.size()) {}
  /// Whether the held part at `X` intersects a fixed one. `freed`: how many pairs of the start had come free there.
  /// Poses along a path, in order, are asked fastest. A question is broken off when `stop` (may be null) becomes true:
  /// then false means nothing.
  bool intersects(const Pose& X, std::uint32_t freed, const std::atomic<bool>* stop = nullptr);

 private:
  const JudgedScene& scene_;
  std::vector<std::optional<FclNearTriangles>> pairs_;  // of just those parts that some pose is near to
  std::vector<std::uint32_t> near_;
};

/// Keeps poses and asks about them afterwards.
class PoseCheck {
 public:
  /// Poses kept; of more, every second, fourth, ... one.
  static constexpr std::size_t kMax = 20000;

  PoseCheck() { poses_.reserve(kMax); }

  /// Never allocates. A pose equal to the last one counts once. `freed`: how many pairs of InitialContactReport had
  /// come free.
  void add(const Pose& X, std::uint32_t freed = 0) noexcept;
  /// How many of the kept poses intersect a fixed part of `scene`, pairs left out that had not come free by then. Works
  /// on all processors; the result does not depend on their number.
  std::int64_t count_intersecting(const Scene& scene, const InitialContactReport& start = {}) const;

 private:
  struct Kept {
    Pose X;
    std::uint32_t freed;
  };
  std::vector<Kept> poses_;
  std::size_t stride_ = 1;
  std::size_t seen_ = 0;
  Pose last_;
};

}  // namespace tegotae
