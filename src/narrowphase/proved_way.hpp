#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "narrowphase/face_pair.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae {

/// A straight way of A that is proved free of some fixed parts, for an A that comes to it apart from them: from where
/// it came to the way it may go along it in both directions, as often as it likes.
class ProvedWay {
 public:
  /// Of a part with its center of mass at `center` (m, file frame), of which no point is farther than `radius` from it;
  /// free of at most `parts` parts.
  ProvedWay(const Vec3& center, double radius, std::size_t parts) : center_(center), radius_(radius) {
    parts_.reserve(parts);
  }

  /// The way from `X` (of A's file frame in the world) by `d` is free of `parts`.
  void set(const Pose& X, const Displacement& d, const std::vector<std::uint32_t>& parts) noexcept;
  void drop() noexcept { known_ = false; }
  /// A is at `X` on the way: what is left of it leads from there to the place `at` on it.
  void cut(const Pose& X, const Pose& at) noexcept;
  /// A is at `X`. The way is proved for an A that comes to it from its beginning, or from where A came to it.
  void come_to(const Pose& X) noexcept;
  /// From `X`, the motion along the way that brings A as near as it can to where `d` would; none where A is not on the
  /// way.
  std::optional<Displacement> toward(const Pose& X, const Displacement& d) const noexcept;
  /// The same from `X` beside the way: the motion onto it, which is not proved. None where that would be at an end of
  /// it.
  std::optional<Displacement> join(const Pose& X, const Displacement& d) const noexcept;
  bool is_on(const Pose& X) const noexcept;
  /// Whether A at `X` comes, going on by `d`, to a place on the way or beside it.
  bool leads_on(const Pose& X, const Displacement& d) const noexcept;
  bool known() const { return known_; }
  const std::vector<std::uint32_t>& parts() const { return parts_; }
  bool ends_at(const Pose& X) const { return place(X) >= kNearlyAll; }
  /// A has been at its end.
  bool done() const { return to_ >= kNearlyAll; }
  const Displacement& motion() const { return d_; }
  Pose end() const { return displaced(X_, center_, d_); }

 private:
  static constexpr double kNearlyAll = 1 - 1e-9;

  /// How far along the way `X` is, as a share of it: below 0 and over 1 beyond its ends.
  double place(const Pose& X) const { return product(displacement(X_, X, center_), d_) / length2_; }
  Pose at(double share) const { return displaced(X_, center_, share * d_); }
  double size(const Displacement& d) const { return d.dp.norm() + radius_ * d.dr.norm(); }
  double product(const Displacement& a, const Displacement& b) const {
    return a.dp.dot(b.dp) + radius_ * radius_ * a.dr.dot(b.dr);
  }

  Vec3 center_;
  double radius_;
  bool known_ = false;
  Pose X_;
  Displacement d_;
  double length2_ = 0;  ///< of d_, m²
  double from_ = 1;     ///< where A came to it, as a share of it
  double to_ = 0;       ///< how far it has come on it
  std::vector<std::uint32_t> parts_;
};

/// Ways that are proved, each from the end of the one before; A is on the first, or beside it. No call but the
/// constructor allocates.
class ProvedWays {
 public:
  struct Stretch {
    ProvedWay way;
    std::vector<FacePair> met;  ///< at its end
  };

  /// As ProvedWay(), with at most `met` pairs of faces at each end.
  ProvedWays(const Vec3& center, double radius, std::size_t parts, std::size_t met);

  bool empty() const { return count_ == 0; }
  bool full() const { return count_ == stretches_.size(); }
  /// Whether one begins at the end of the first.
  bool lead_on() const { return count_ > 1; }
  const Stretch& first() const { return stretches_.front(); }     ///< if there is one
  const Stretch& last() const { return stretches_[count_ - 1]; }  ///< the same
  /// A is at `X`, on the first way or on one of the next, which is the first from now on.
  void come_to(const Pose& X) noexcept;
  /// The way from `X` by `d` is free of `parts`, and `met` at its end. The others go if it does not begin on the last
  /// of them, or if they are full.
  void add(const Pose& X, const Displacement& d, const std::vector<std::uint32_t>& parts,
           const std::vector<FacePair>& met) noexcept;
  /// A is at `X` on the first way, which leads from there to the place `at` on it from now on; the others go. Nothing
  /// where one of both is not on it.
  void turn_off(const Pose& X, const Pose& at) noexcept;
  void drop() noexcept { count_ = 0; }

 private:
  static constexpr std::size_t kMost = 8;

  std::vector<Stretch> stretches_;
  std::size_t count_ = 0;
};

}  // namespace tegotae
