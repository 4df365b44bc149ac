#pragma once

#include <memory>
#include <vector>

#include "feature/tracker.hpp"
#include "narrowphase/face_pair.hpp"
#include "tegotae/contact/contact.hpp"

namespace tegotae {

/// A fixed part as contacts see it.
struct FixedSurface {
  std::shared_ptr<const Surface> surface;
  Pose X_WB;
  std::uint32_t stands_for = kNone;  ///< number of the part that contacts name; kNone: its own
};

/// The nearest-feature pairs of the held part with the fixed parts, followed from tick to tick, and the limits they put
/// on its motion. A pair keeps its identity (part and features) and counts its age.
class ContactSet {
 public:
  ContactSet(std::shared_ptr<const Surface> held, std::vector<FixedSurface> fixed, const Vec3& center, int capacity);

  /// Follows every pair to its local minimum of distance at `X`, drops those farther than `reach` (m) and duplicates,
  /// and lists the limits anew. Ends early after `deadline_ns` of monotonic_ns() with false: the limits are then still
  /// those of the last track that was finished, and the next call goes on where this one stopped if it has the same `X`
  /// and `reach`.
  bool track(const Pose& X, double reach, std::int64_t deadline_ns);
  /// Forgets all pairs and limits.
  void clear();
  /// Goes on with the pairs of fixed surface `from` on `to`, which has the same features a little elsewhere.
  void transfer(std::uint32_t from, std::uint32_t to) noexcept;
  /// Starts pairs from triangle pairs: nearest features at `X_near` (close to the contact), followed to their minimum
  /// at the pose of the last track(). Returns how many pairs within reach were not known yet. Ends early after
  /// `deadline_ns` of monotonic_ns().
  int seed(const std::vector<FacePair>& triangles, const Pose& X_near, std::int64_t deadline_ns);
  /// Adds limits for this tick only: for each triangle pair (free at the last track()) the separating axis that limits
  /// the displacement `d` least, of those that leave `clearance` (m). Returns how many were added. Ends early after
  /// `deadline_ns`.
  int cut(const std::vector<FacePair>& triangles, const Displacement& d, double clearance, std::int64_t deadline_ns);

  const std::vector<Contact>& limits() const { return limits_; }
  /// Limits that were dropped since the last track() because the capacity was used up.
  int overflow() const { return overflow_; }

 private:
  struct Pair {
    std::uint32_t part;
    Feature a, b;
    int age;
  };

  bool known(std::uint32_t part, Feature a, Feature b) const;
  void remember(const Pair& pair);
  void begin_track(const Pose& X, double reach);
  /// Drops pairs that other pairs speak for: a corner or edge inside a flat region is no minimum of its own.
  bool redundant(std::uint32_t part, Feature a, Feature b) const;
  void add_limits(const Pair& pair, const FeaturePair& at, std::vector<Contact>& limits);
  void add_reflex_limits(const Pair& pair, const FeaturePair& at, std::vector<Contact>& limits);
  void add(const Contact& contact, std::vector<Contact>& limits);
  Vec3 normal_B(std::uint32_t part, const FeaturePair& at) const;
  std::size_t slot(std::uint32_t part, Feature a, Feature b) const;

  std::shared_ptr<const Surface> held_;
  std::vector<FixedSurface> fixed_;
  Vec3 center_;
  int capacity_;
  Pose X_;
  double reach_ = 0;
  std::vector<Pair> pairs_;  ///< of the last finished track; `followed_` of them are in next_ already
  std::vector<Pair> next_;   ///< of this track
  std::size_t followed_ = 0;
  std::vector<std::int32_t> table_;  ///< open addressing into next_, -1 is empty
  std::vector<std::size_t> taken_;   ///< places of table_ that are not
  std::vector<Contact> limits_;
  std::vector<Contact> next_limits_;  ///< of this track, until it is finished
  int overflow_ = 0;
};

}  // namespace tegotae
