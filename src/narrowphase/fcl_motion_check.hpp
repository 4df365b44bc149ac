#pragma once

#include "narrowphase/fcl_narrow_phase.hpp"
#include "narrowphase/motion_check.hpp"

namespace tegotae {

/// The paper's way: FCL looks at the end of a motion only, so motions are kept short (a sheet thinner than that can be
/// passed), and an intersection is backed off from.
class FclMotionCheck final : public MotionCheck {
 public:
  /// `fixed` and `poses` by part number; `radius` of A about its center of mass `center` (m, file frame), `back_off`
  /// the paper's l_0 (m).
  FclMotionCheck(const TriangleMesh& held, const Vec3& center, double radius,
                 const std::vector<const TriangleMesh*>& fixed, std::vector<Pose> poses, double back_off);

  void begin(const std::vector<std::uint32_t>& near, std::int64_t deadline_ns, OtherParts others) noexcept override;
  MotionAnswer check(const Pose& X, const Displacement& d, double clearance,
                     std::vector<FacePair>& blocking) noexcept override;
  double free_share() const override { return free_ ? 1 : 0; }
  MotionAnswer stands(const Pose& X, std::uint32_t part, double clearance, std::int64_t) noexcept override;
  Pose near_contact(const Pose& X, const Displacement& d, const std::vector<FacePair>& blocking) noexcept override;
  double longest_motion() const override;
  bool overflow() const override { return false; }

 private:
  const TriangleMesh& held_;
  Vec3 center_;
  double radius_;
  std::vector<Pose> poses_;
  double back_off_;
  FclNarrowPhase narrow_;
  const std::vector<std::uint32_t>* near_ = nullptr;
  bool free_ = false;  ///< the last check
};

}  // namespace tegotae
