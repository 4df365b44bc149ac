#pragma once

#include <array>
#include <memory>
#include <vector>

#include "contact/asked.hpp"
#include "contact/contact_choice.hpp"
#include "feature/nearest_face.hpp"
#include "feature/tracker.hpp"
#include "narrowphase/face_pair.hpp"
#include "tegotae/contact/contact.hpp"

namespace tegotae {

/// A fixed part as contacts see it.
struct FixedSurface {
  std::shared_ptr<const Surface> surface;
  Pose X_WB;
  PartId part = {};  ///< that contacts name
};

/// The nearest-feature pairs of the held part with the fixed parts, followed from tick to tick, and the constraints
/// they put on its motion. A pair keeps its identity (part and features) and counts its age.
class ContactSet {
 public:
  /// Pairs that are followed from one tick to the next: each costs about a microsecond, and nothing moves before all
  /// are followed.
  static constexpr std::size_t kMaxFollowed = 256;

  ContactSet(std::shared_ptr<const Surface> held, std::vector<FixedSurface> fixed, const Vec3& center, int capacity,
             std::size_t max_followed = kMaxFollowed);

  /// Follows every pair to its local minimum of distance at `X`, drops those farther than `reach` (m) and duplicates,
  /// and lists the constraints anew. Where more pairs are left than are followed, keeps those that carried force, those
  /// that support the part to all sides, and then the nearest; what was dropped comes back by seed() when it is in the
  /// way. Ends early after `deadline_ns` of monotonic_ns() with false: the constraints are then still those of the last
  /// track that was finished, and the next call goes on where this one stopped if it has the same `X` and `reach`.
  bool track(const Pose& X, double reach, std::int64_t deadline_ns);
  /// Forgets all pairs and constraints.
  void clear();
  /// Goes on with the pairs of fixed surface `from` on `to`, which has the same features a little elsewhere.
  void transfer(std::uint32_t from, std::uint32_t to) noexcept;
  /// Starts pairs from triangle pairs that were in the way of a motion (free at the last track()): from their nearest
  /// features at `X_near` (close to the contact), the corners of the flat regions that they lie in, their own corners,
  /// and where their rims cross; each followed to its minimum at the pose of the last track(). Where none of these
  /// holds the part, the nearest points of the two triangles do. Returns how many pairs within reach were not known
  /// yet. Ends early after `deadline_ns` of monotonic_ns(), or when it has found many.
  int seed(const std::vector<FacePair>& triangles, const Pose& X_near, std::int64_t deadline_ns);
  /// Adds constraints for this tick only: for each triangle pair (free at the last track()) the separating axis that
  /// limits the displacement `d` least, of those that leave `clearance` (m). Returns how many were added. Ends
  /// early after `deadline_ns`.
  int add_cutting_planes(const std::vector<FacePair>& triangles, const Displacement& d, double clearance,
                         std::int64_t deadline_ns);
  /// Whether the two triangles that constraint number `constraint`, from add_cutting_planes(), keeps apart are at most
  /// `distance` (m) from each other at the pose of the last track().
  bool touches(std::size_t constraint, double distance) const noexcept;
  /// A pair of faces for each contact that is no farther than `distance` (m) at the pose of the last track(), up to
  /// `most`, for seed() to find it again.
  void faces_within(double distance, std::size_t most, std::vector<FacePair>& faces) const noexcept;
  /// Constraint number `constraint` carries force: the next track() keeps its pair, whatever it drops.
  void carries(std::size_t constraint) noexcept;

  const std::vector<Contact>& constraints() const { return constraints_; }
  /// Pairs within reach that the last track() dropped because there were too many, and constraints dropped since
  /// because the capacity was used up.
  int overflow() const { return overflow_; }
  std::size_t followed() const { return pairs_.size(); }  ///< pairs

 private:
  struct Pair {
    std::uint32_t part;
    Feature a, b;
    int age;
    bool support;  ///< no minimum of its own, but it was in the way and no other pair spoke for it
    bool carries;  ///< force, in the last tick
  };
  /// A held feature and a fixed one, by flat region or face, whose corners were tried at this pose.
  struct TriedRegions {
    std::uint32_t part;
    std::uint64_t a, b;
    bool operator==(const TriedRegions& o) const { return part == o.part && a == o.a && b == o.b; }
  };
  /// Of all features of a mesh.
  static std::uint64_t number(Feature f) { return std::uint64_t{f.index} * 3 + static_cast<std::uint64_t>(f.kind); }
  std::size_t slot(std::uint32_t part, Feature a, Feature b) const;
  bool known(std::uint32_t part, Feature a, Feature b) const;
  void remember(const Pair& pair);
  void forget_places();
  void begin_track(const Pose& X, double reach);
  FeaturePair follow(const Pair& pair) const;
  void choose();
  void keep(const std::vector<std::uint8_t>& kept);
  /// Drops pairs that other pairs speak for: a corner or edge inside a flat region is not a minimum of its own.
  bool redundant(std::uint32_t part, Feature a, Feature b) const;
  /// Whether contacts around that point the same way hold what this constraint of `part` would.
  bool spoken_for(const Contact& constraint, std::uint32_t part, const std::vector<Contact>& constraints,
                  const std::vector<std::uint32_t>& owners) const;

  // Seeds; each returns how many fresh pairs it found. One pair of triangles may ask for hundreds of nearest faces, so
  // all look at the clock; what is left comes with the next tick.
  bool out_of_time() const;
  int seed_pair(const FacePair& t, const Pose& X_near);
  int seed_regions_at(std::uint32_t part, const FeaturePair& at);
  int seed_regions(const FacePair& t);
  int seed_crossings(const FacePair& t);
  int seed_corner_of_a(const FacePair& t, std::uint32_t vertex);
  int seed_corners(const FacePair& t);
  int seed_rims(const FacePair& t);
  int seed_vertex_of_a(std::uint32_t part, std::uint32_t vertex, std::uint32_t face_b);
  int seed_vertex_of_b(std::uint32_t part, std::uint32_t face_a, std::uint32_t vertex);
  int start_on_b(std::uint32_t part, std::uint32_t vertex, const NearFace& near);
  int start(std::uint32_t part, Feature a, Feature b);
  int take(std::uint32_t part, const FeaturePair& at, bool support);
  bool try_first_time(const FacePair& t);
  enum class Ask : std::uint8_t { features, corner_of_a, corner_of_b };
  /// Whether that was asked at this pose before, and brought what it brings.
  bool asked(Ask what, std::uint32_t part, std::uint64_t a, std::uint64_t b) noexcept;
  /// X_BA of the held part in the fixed one, at the pose of the track.
  const Pose& pose_in(std::uint32_t part) const;

  void add_constraints(std::uint32_t pair, const FeaturePair& at, std::vector<Contact>& constraints,
                       std::vector<std::uint32_t>& owners);
  void add_reflex_constraints(std::uint32_t pair, const FeaturePair& at, std::vector<Contact>& constraints,
                              std::vector<std::uint32_t>& owners);
  bool add(const Contact& contact, std::vector<Contact>& constraints);
  Contact constraint_of(std::uint32_t part, const FeaturePair& at, int age) const;
  Vec3 normal_B(std::uint32_t part, const FeaturePair& at) const;

  std::shared_ptr<const Surface> held_;
  std::vector<FixedSurface> fixed_;
  NearestFace near_held_;
  std::vector<NearestFace> near_fixed_;
  Vec3 center_;
  int capacity_;
  std::size_t max_followed_;
  ContactChoice choice_;
  std::vector<std::uint8_t> must_;  ///< of each pair
  Pose X_;
  Vec3 center_W_ = Vec3::Zero();  ///< center_ at X_, in the world
  struct Relative {
    Pose X_BA;
    std::uint64_t at;  ///< the pose of which number it is of
  };
  mutable std::vector<Relative> relative_;  ///< of each fixed part, made when it is asked for
  std::uint64_t poses_ = 1;                 ///< number of X_ among all poses so far
  double reach_ = 0;
  std::vector<Pair> pairs_;  ///< of the last finished track; `followed_` of them are in next_ already
  std::vector<Pair> next_;   ///< of this track
  std::size_t followed_ = 0;
  std::vector<std::int32_t> table_;  ///< open addressing into next_, -1 is empty
  std::vector<std::size_t> taken_;   ///< places of table_ that are not
  std::vector<Contact> constraints_;
  std::vector<FacePair> cut_;               ///< by constraints for this tick only
  std::vector<std::uint32_t> owners_;       ///< of each constraint: its pair, kNone for a cutting plane
  std::vector<Contact> next_constraints_;   ///< of this track, until it is finished
  std::vector<std::uint32_t> next_owners_;  ///< likewise
  std::int64_t deadline_ns_ = 0;            ///< of the call of seed()
  Asked asked_;                             ///< of this track's pose
  std::array<TriedRegions, 64> tried_;
  std::size_t tried_count_ = 0;
  int overflow_ = 0;
};

}  // namespace tegotae
