#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "narrowphase/face_pair.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae {

/// Where the held part has come from: poses between which it went by straight motions that were free of all parts. So
/// are the same motions back, without a question, as long as no part has moved or begun to count since. Where the part
/// goes back along it, what it came by is ahead of it, until it turns off: then one side goes, the one on which it
/// is farther to where the part touched something. No call but the constructor allocates.
class Trail {
 public:
  static constexpr std::size_t kPoses = 256;
  static constexpr std::size_t kFaces = 8;
  enum class Side : std::uint8_t { back, ahead };

  /// Turns are about `center` (file frame), from which the part's points are up to `radius` (m) away.
  Trail(const Vec3& center, double radius);

  void forget() noexcept { count_ = here_ = 0; }
  /// The part went from `from` straight to `to`.
  void went(const Pose& from, const Pose& to) noexcept;
  /// The part went straight to `X`, on the way to that pose from the one before.
  void crossed_to(Side side, std::size_t i, const Pose& X) noexcept;
  /// What it touches where it is; the first kFaces of them are kept.
  void touches(const std::vector<FacePair>& faces) noexcept;

  /// Whether the part at `X` is on it.
  bool is_at(const Pose& X) const noexcept;
  /// Poses on a side of the part. Number 0 is where it is, the others, up to this one, from there on.
  std::size_t count(Side side) const { return count_ == 0 ? 0 : (side == Side::back ? here_ : count_ - 1 - here_); }
  const Pose& pose(Side side, std::size_t i) const { return place(number(side, i)).X; }
  /// Whether the part touched something there.
  bool touched_at(Side side, std::size_t i) const { return place(number(side, i)).touched > 0; }
  /// To `faces`: what it touched where it is.
  void touched(std::vector<FacePair>& faces) const noexcept;

 private:
  struct Place {
    Pose X;
    std::array<FacePair, kFaces> faces;
    std::size_t touched = 0;
  };
  std::size_t number(Side side, std::size_t i) const { return side == Side::back ? here_ - i : here_ + i; }
  const Place& place(std::size_t i) const { return places_[(first_ + i) % kPoses]; }
  Place& place(std::size_t i) { return places_[(first_ + i) % kPoses]; }
  void add(const Pose& X) noexcept;
  void turn_off() noexcept;
  std::size_t nearest_touched(Side side) const noexcept;
  void split(Side side, const Pose& X) noexcept;
  void insert(std::size_t at, const Pose& X) noexcept;
  void drop_first() noexcept;
  bool passes(const Pose& from, const Pose& to, const Pose& X) const noexcept;

  Vec3 center_;
  double radius_;
  std::vector<Place> places_;
  std::size_t first_ = 0, count_ = 0, here_ = 0;
};

}  // namespace tegotae
