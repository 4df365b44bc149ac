#include <algorithm>
#include <cmath>

#include "narrowphase/columns.hpp"
#include "narrowphase/moving_plane.hpp"

namespace tegotae {
namespace {

/// A box of A at one end of a motion as a box of B sees it: the way from B's center to A's, then A's axes.
using SeenBox = Columns;

/// A box of A at the two ends of a motion and a box of B.
struct BoxPair {
  SeenBox a0, a1;
  Columns b;    ///< axes, and nothing
  Four ha, hb;  ///< nothing and A's half extents; B's and nothing

  TEGOTAE_INLINE BoxPair(const PatchNode& a, const Vec3& center_a, const PatchNode& b_node, const Sweep& sweep) {
    const Columns rests = {Four{center_a.x(), a.axis[0][0], a.axis[1][0], a.axis[2][0]},
                           Four{center_a.y(), a.axis[0][1], a.axis[1][1], a.axis[2][1]},
                           Four{center_a.z(), a.axis[0][2], a.axis[1][2], a.axis[2][2]}};
    a0 = seen(rests, sweep.start, b_node);
    a1 = seen(rests, sweep.end, b_node);
    b = {Four{b_node.axis[0][0], b_node.axis[1][0], b_node.axis[2][0], 0},
         Four{b_node.axis[0][1], b_node.axis[1][1], b_node.axis[2][1], 0},
         Four{b_node.axis[0][2], b_node.axis[1][2], b_node.axis[2][2], 0}};
    ha = Four{0, a.half[0], a.half[1], a.half[2]};
    hb = Four{b_node.half[0], b_node.half[1], b_node.half[2], 0};
  }

  TEGOTAE_INLINE double start(const Vec3& n) const { return gap(n, a0); }
  TEGOTAE_INLINE double end(const Vec3& n) const { return gap(n, a1); }
  /// Twice the mixed term of the gap: least of n0·x1 + n1·x0 over A less both supports of B.
  TEGOTAE_INLINE double mixed(const Vec3& n0, const Vec3& n1) const {
    const Four along = dot(n0, a1) + dot(n1, a0);
    return along[0] - sum(ha * magnitude(along) + hb * (magnitude(dot(n0, b)) + magnitude(dot(n1, b))));
  }

 private:
  static TEGOTAE_INLINE SeenBox seen(const Columns& rests, const Placement& at, const PatchNode& b_node) {
    SeenBox c = rotated(at.R, rests);
    c.x += Four{at.t.x() - b_node.center[0], 0, 0, 0};
    c.y += Four{at.t.y() - b_node.center[1], 0, 0, 0};
    c.z += Four{at.t.z() - b_node.center[2], 0, 0, 0};
    return c;
  }
  TEGOTAE_INLINE double gap(const Vec3& n, const SeenBox& a) const {
    const Four along = dot(n, a);
    return along[0] - sum(ha * magnitude(along) + hb * magnitude(dot(n, b)));
  }
};

/// Separation of two boxes along the normals of their faces, negative signs folded in: sep[i] along sign[i] · axis i,
/// B's axes first.
struct BoxFaces {
  std::array<double, 6> sep;
  std::array<double, 6> sign;

  TEGOTAE_INLINE BoxFaces(const BoxPair& pair, const SeenBox& a) {
    Four spans = pair.ha;  // of A's faces
    for (int i = 0; i < 3; ++i) {
      const Four along = dot(pair.b.column(i), a), m = magnitude(along);
      set(i, along[0], pair.hb[i] + sum(pair.ha * m));
      spans += pair.hb[i] * m;
    }
    const Four along = dot(a.column(0), a);
    for (int i = 0; i < 3; ++i) set(3 + i, along[i + 1], spans[i + 1]);
  }

 private:
  TEGOTAE_INLINE void set(int k, double along, double span) {
    sep[k] = std::abs(along) - span;
    sign[k] = along < 0 ? -1 : 1;
  }
};

TEGOTAE_INLINE Vec3 box_axis(int k, const SeenBox& a, const Columns& b) {
  return k < 3 ? b.column(k) : a.column(k - 2);
}

}  // namespace

TEGOTAE_WIDE bool separate_boxes(const PatchNode& a, const Vec3& center_a, const PatchNode& b, const Sweep& sweep,
                                 double reach, double spare, double worth_of_a, MovingPlane& plane) {
  const BoxPair pair(a, center_a, b, sweep);
  const Bulge bulge(sweep, reach, 0, 1);
  if (stays_apart(pair, plane.n0, plane.n1, bulge, sweep, spare)) return true;
  const BoxFaces at_start(pair, pair.a0);
  int first = 0;
  for (int k = 1; k < 6; ++k) {
    if (at_start.sep[k] > at_start.sep[first]) first = k;
  }
  if (!(at_start.sep[first] > 0)) return false;
  const BoxFaces at_end(pair, pair.a1);
  int last = 0, together = -1;
  double both = 0;
  for (int k = 0; k < 6; ++k) {
    if (at_end.sep[k] > at_end.sep[last]) last = k;
    const double s = (k < 3 ? 1 : worth_of_a) * std::min(at_start.sep[k], at_end.sep[k]);
    if (at_start.sign[k] == at_end.sign[k] && s > both) both = s, together = k;
  }
  for (const auto& [i, j] : {std::pair(together, together), std::pair(first, last)}) {
    if (i < 0 || !(at_end.sep[j] > 0)) continue;
    const Vec3 n0 = at_start.sign[i] * box_axis(i, pair.a0, pair.b);
    const Vec3 n1 = at_end.sign[j] * box_axis(j, pair.a1, pair.b);
    if (!stays_apart(pair, n0, n1, bulge, sweep, spare)) continue;
    plane = {n0, n1, j >= 3};
    return true;
  }
  return false;
}

}  // namespace tegotae
