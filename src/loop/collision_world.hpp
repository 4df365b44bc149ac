#pragma once

#include <memory>
#include <vector>

#include "broadphase/bounding_boxes.hpp"
#include "broadphase/bounding_spheres.hpp"
#include "contact/contact_set.hpp"
#include "loop/initial_contacts.hpp"
#include "narrowphase/motion_check.hpp"
#include "narrowphase/patch_motion_check.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/mesh/mass.hpp"

namespace tegotae {

/// Feature pairs, and constraints from them, that a tick can hold; more are counted as overflow.
inline constexpr int kMaxConstraints = 4096;

/// What every loop that never penetrates holds of its scene.
struct CollisionWorld {
  double radius;  ///< of the held part about its center of mass, m
  double reach;   ///< pairs of features farther apart are not followed, m
  BoundingSpheres spheres;
  BoundingBoxes boxes;
  std::unique_ptr<MotionCheck> check;
  std::unique_ptr<ContactSet> contacts;
  InitialContacts start;
  Pose X;  ///< where the held part starts: where the scene puts it, or moved off what it touches there

  /// Throws Error when the held part overlaps a fixed one and the settings do not say to ignore it.
  CollisionWorld(const Scene& scene, const ContactSettings& settings, const MassProperties& mass,
                 ProofEffort effort = ProofEffort::full);

  /// Parts whose sphere and box come within `distance` (m) of the held part's at `pose`, as the checks number them.
  void query(const Pose& pose, const Vec3& center, double distance, std::vector<std::uint32_t>& near) const;
  /// Polls whether one more pair that was not free at the start is free at `pose` (see InitialContacts::poll), in a
  /// share of the tick's budget. When it is, the caller tracks contacts anew.
  bool poll_initial_contacts(const Pose& pose) noexcept;
  /// Whether the straight way of the held part from `from` to `to` is known by `deadline_ns` to be free of the `fresh`
  /// parts (null: of all). `near` and `blocking` are scratch.
  bool is_path_free(const Pose& from, const Pose& to, const Vec3& center, const std::vector<bool>* fresh,
                    std::int64_t deadline_ns, std::vector<std::uint32_t>& near,
                    std::vector<FacePair>& blocking) const noexcept;

  /// Sets what a report says of contacts, constraints and pairs that were not free at the start. Gaps of at most
  /// `contact_gap` (m) count as contact.
  void fill_report(double contact_gap, TickReport& report) const noexcept;

 private:
  Box box_;           ///< of the held part
  double poll_time_;  ///< s
};

}  // namespace tegotae
