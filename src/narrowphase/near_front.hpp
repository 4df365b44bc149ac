#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "narrowphase/patch_tree.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae {

/// What NearFront asks about the triangles of two leaves that may be near.
class LeafQuery {
 public:
  virtual ~LeafQuery() = default;
  /// Returns a lower bound (m) of the distance between the triangles of the leaf `a` of A and those of the leaf `b` of
  /// B; may lower `bound`. `normal` comes in as a unit direction from B to A (B's axes) along which the leaves were
  /// farthest apart, and may be replaced by a better one.
  virtual double distance(const PatchNode& a, const PatchNode& b, Vec3& normal, double& bound) = 0;
};

/// Which triangles of two surfaces may be nearer to each other than a bound, pose after pose: a front of pairs of
/// patches that covers all pairs of triangles, each with a direction along which it was apart and with how far. A pair
/// is not looked at before the part has moved so far that it may have come under the bound; the front is taken apart
/// where it must be, of two halves the nearer one first, and built anew when it has grown.
///
/// For poses at rest and in double precision, with bounds of its own: what it is used for checks the certificate of
/// motions (PatchFront). Mutable scratch of one thread; allocates.
class NearFront {
 public:
  /// Pairs this much (m) under the bound are not looked at: what rounding makes of equal distances.
  static constexpr double kTolerance = 1e-12;

  NearFront(std::shared_ptr<const PatchTree> a, std::shared_ptr<const PatchTree> b);

  /// Asks `leaves` about all pairs of leaves that may be nearer than `bound` (m) - kTolerance with A's file frame at
  /// `X_BA` in B's. Ends early when `bound` has become 0 or less. Poses along a path, in order, are asked fastest.
  void query(const Pose& X_BA, double& bound, LeafQuery& leaves);

  const PatchTree& a() const { return *a_; }
  const PatchTree& b() const { return *b_; }
  std::size_t pairs() const { return front_.size(); }

 private:
  struct Pair {
    std::uint32_t a, b;  ///< nodes
    Vec3 normal;         ///< unit, from B to A, B's axes
    double arm;          ///< m, that no point of the node of A is farther from the origin of its tree
    double until;        ///< gone() at which the pair may touch: its gap when it was looked at, and what was gone then
  };
  struct Open {
    double gap;     ///< lower bound of the distance
    bool searched;  ///< the best direction has been looked for
    Pair pair;
  };

  void place(const Pose& X_BA);
  /// m, that no point of the pair's node of A has gone farther than since the front was built.
  double gone(const Pair& pair) const { return way_ + pair.arm * turn_; }
  double gap(const Pair& pair) const;
  double search(Pair& pair, double enough) const;
  void collect(double& bound, LeafQuery& leaves);
  void open(const Pair& pair, double gap, double bound, bool searched);
  void split(const Open& top, double bound);
  void keep(Pair pair, double gap);

  std::shared_ptr<const PatchTree> a_, b_;
  std::vector<double> arms_;   // of the nodes of A, see Pair
  Pose X_;                     // of the last query
  Mat3 R_;                     // from A's axes to B's
  Vec3 t_;                     // A's tree origin from B's, B's axes
  double way_ = 0, turn_ = 0;  // of A's tree origin (m) and about it (rad) since the front was built
  bool placed_ = false;
  std::vector<Pair> front_;
  std::vector<Open> open_;  // stack
  std::size_t built_ = 0;   // pairs when the front was built
};

}  // namespace tegotae
