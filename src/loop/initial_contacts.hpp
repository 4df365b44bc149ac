#pragma once

#include <memory>
#include <vector>

#include "loop/containment_test.hpp"
#include "narrowphase/motion_check.hpp"
#include "narrowphase/patch_tree.hpp"
#include "tegotae/loop/initial_contacts.hpp"
#include "tegotae/loop/scene.hpp"

namespace tegotae {

/// No sub-step of a motion brings any triangles nearer than this gap (m). Collision libraries with a tolerance of 1 µm
/// (Coal's GJK) count nearer ones as touching, and a recording should be free for them too.
inline constexpr double kGapFloor = 1.1e-6;

/// The pairs of parts that are not free at the start, until they are: touching ones whose fixed part a smaller copy
/// stands in for, and suspended ones. Fixed parts are numbered as in SceneParts.
class InitialContacts {
 public:
  static constexpr std::uint32_t kNobody = 0xffffffffu;

  /// A pair that is not active.
  struct Waiting {
    std::size_t pair = 0;                     ///< number in the report
    std::uint32_t part = 0;                   ///< the fixed part
    std::uint32_t stand_in = kNobody;         ///< number of the smaller copy; kNobody: suspended
    std::unique_ptr<ContainmentTest> inside;  ///< of a suspended pair
    Pose X_WB;
  };
  /// A smaller copy of a fixed part.
  struct Copy {
    std::uint32_t part = 0;
    std::shared_ptr<const TriangleMesh> mesh;
    std::shared_ptr<const PatchTree> tree;
  };

  InitialContacts() = default;
  /// Sorts the pairs of the held part with the others. Throws Error naming the pair, depth and place when parts overlap
  /// and the settings do not say to ignore it.
  InitialContacts(const Scene& scene, const ContactSettings& settings);

  /// For every pair that touches and is nearer than kGapFloor a copy of the fixed part whose faces lie deeper by as
  /// much as is missing: then no motion that leaves kGapFloor to the copy brings the parts deeper into each other than
  /// they are. The copies are numbered from `first` on, in this order. `center` of mass of the held part (file frame).
  /// A pair that no copy frees counts as overlapping.
  std::vector<Copy> shrink(const Scene& scene, const Vec3& center, std::uint32_t first);

  const InitialContactReport& report() const { return report_; }
  std::size_t waiting() const { return count_; }
  const Waiting& waiting(std::size_t i) const { return waiting_[i]; }
  int filtered() const { return filtered_; }
  int shrunk() const { return static_cast<int>(count_) - filtered_; }

  /// Takes suspended parts out of a list of fixed parts, and puts copies in the place of theirs.
  void apply(std::vector<std::uint32_t>& near) const noexcept;
  /// Asks of one waiting pair whether it is free at `X` by kGapFloor; of the next one in the next call. When it is, it
  /// is active from now on and returned, otherwise null. Before MotionCheck::begin() of the tick. Never allocates.
  const Waiting* poll(const Pose& X, MotionCheck& check, std::int64_t deadline_ns) noexcept;
  /// Makes waiting pair `i` active; it was freed before the first tick.
  void free_at_start(std::size_t i);
  void set_shift(double shift) { report_.shift = shift; }

 private:
  void filter_or_refuse(const Scene& scene, InitialContact& pair, const std::string& why);
  void retire(std::size_t i) noexcept;

  InitialContactReport report_;
  std::vector<std::uint32_t> number_;  ///< of each part of the scene among the fixed ones
  std::vector<Waiting> waiting_;       ///< the first `count_` of them still do
  std::size_t count_ = 0, next_ = 0, polled_ = 0;
  int filtered_ = 0;
  std::uint32_t freed_ = 0;
  Pose last_;
  bool ignore_ = false;
  double tolerance_ = 0;
};

}  // namespace tegotae
