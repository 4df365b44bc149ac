#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "narrowphase/face_pair.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae {

/// Where the held part has come from: poses between which it went by straight motions that were free of all parts. So
/// are the same motions back, without a question, as long as no part has moved or begun to count since. The part is at
/// the last pose. No call but the constructor allocates.
class Trail {
 public:
  static constexpr std::size_t kPoses = 256;
  static constexpr std::size_t kFaces = 8;

  /// Turns are about `center` (file frame), from which the part's points are up to `radius` (m) away.
  Trail(const Vec3& center, double radius);

  void forget() noexcept { count_ = 0; }
  /// The part went from `from` straight to `to`. Where it went back along the trail, it has not come from farther.
  void went(const Pose& from, const Pose& to) noexcept;
  /// What it touches where it is; the first kFaces of them are kept.
  void touches(const std::vector<FacePair>& faces) noexcept;

  /// Whether the part at `X` is on it.
  bool is_at(const Pose& X) const noexcept;
  /// Poses on it; number 0 is where the part is, the others from there back.
  std::size_t count() const { return count_; }
  const Pose& pose(std::size_t back) const { return place(back).X; }
  /// Whether the part touched something there.
  bool touched_at(std::size_t back) const { return place(back).touched > 0; }
  /// To `faces`: what it touched where it is.
  void touched(std::vector<FacePair>& faces) const noexcept;
  /// Back along it, to pose number 1.
  void go_back() noexcept { --count_; }

 private:
  struct Place {
    Pose X;
    std::array<FacePair, kFaces> faces;
    std::size_t touched = 0;
  };
  const Place& place(std::size_t back) const { return places_[(first_ + count_ - 1 - back) % kPoses]; }
  Place& here() { return places_[(first_ + count_ - 1) % kPoses]; }
  void add(const Pose& X) noexcept;
  bool passes(const Pose& from, const Pose& to, const Pose& X) const noexcept;

  Vec3 center_;
  double radius_;
  std::vector<Place> places_;
  std::size_t first_ = 0, count_ = 0;
};

}  // namespace tegotae
