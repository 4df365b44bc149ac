#include <algorithm>
#include <cmath>

#include "narrowphase/moving_plane.hpp"

namespace tegotae {
namespace {

/// Separation of two boxes along the normals of their faces, negative signs folded in: sep[i] along sign[i] · axis i,
/// B's axes first.
struct BoxFaces {
  std::array<double, 6> sep;
  std::array<double, 6> sign;

  BoxFaces(const Vec3& d, const std::array<Vec3, 3>& a, const std::array<double, 3>& ha, const std::array<Vec3, 3>& b,
           const std::array<double, 3>& hb) {
    std::array<std::array<double, 3>, 3> m;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) m[i][j] = std::abs(b[i].dot(a[j]));
    }
    for (int i = 0; i < 3; ++i) {
      set(i, d.dot(b[i]), hb[i] + ha[0] * m[i][0] + ha[1] * m[i][1] + ha[2] * m[i][2]);
      set(3 + i, d.dot(a[i]), ha[i] + hb[0] * m[0][i] + hb[1] * m[1][i] + hb[2] * m[2][i]);
    }
  }

 private:
  void set(int k, double along, double span) {
    sep[k] = std::abs(along) - span;
    sign[k] = along < 0 ? -1 : 1;
  }
};

const Vec3& box_axis(int k, const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  return k < 3 ? b[k] : a[k - 3];
}

}  // namespace

BoxPair::BoxPair(const PatchNode& a, const Vec3& center_a, const PatchNode& b_node, const Sweep& sweep) {
  d0 = sweep.start.R * center_a + sweep.start.t - b_node.center_vec();
  d1 = sweep.end.R * center_a + sweep.end.t - b_node.center_vec();
  for (int i = 0; i < 3; ++i) {
    const Vec3 u = a.axis_vec(i);
    a0[i] = sweep.start.R * u;
    a1[i] = sweep.end.R * u;
    b[i] = b_node.axis_vec(i);
    ha[i] = a.half[i];
    hb[i] = b_node.half[i];
  }
}

double BoxPair::start(const Vec3& n) const {
  double s = n.dot(d0);
  for (int i = 0; i < 3; ++i) s -= ha[i] * std::abs(n.dot(a0[i])) + hb[i] * std::abs(n.dot(b[i]));
  return s;
}

double BoxPair::end(const Vec3& n) const {
  double s = n.dot(d1);
  for (int i = 0; i < 3; ++i) s -= ha[i] * std::abs(n.dot(a1[i])) + hb[i] * std::abs(n.dot(b[i]));
  return s;
}

double BoxPair::mixed(const Vec3& n0, const Vec3& n1) const {
  double s = n0.dot(d1) + n1.dot(d0);
  for (int i = 0; i < 3; ++i) {
    s -= ha[i] * std::abs(n0.dot(a1[i]) + n1.dot(a0[i])) + hb[i] * (std::abs(n0.dot(b[i])) + std::abs(n1.dot(b[i])));
  }
  return s;
}

bool separate_boxes(const BoxPair& pair, const Sweep& sweep, double reach, double spare, double worth_of_a,
                    MovingPlane& plane) {
  const Bulge bulge(sweep, reach, 0, 1);
  if (stays_apart(pair, plane.n0, plane.n1, bulge, sweep, spare)) return true;
  const BoxFaces at_start(pair.d0, pair.a0, pair.ha, pair.b, pair.hb);
  int first = 0;
  for (int k = 1; k < 6; ++k) {
    if (at_start.sep[k] > at_start.sep[first]) first = k;
  }
  if (!(at_start.sep[first] > 0)) return false;
  const BoxFaces at_end(pair.d1, pair.a1, pair.ha, pair.b, pair.hb);
  int last = 0, together = -1;
  double both = 0;
  for (int k = 0; k < 6; ++k) {
    if (at_end.sep[k] > at_end.sep[last]) last = k;
    const double s = (k < 3 ? 1 : worth_of_a) * std::min(at_start.sep[k], at_end.sep[k]);
    if (at_start.sign[k] == at_end.sign[k] && s > both) both = s, together = k;
  }
  auto try_pair = [&](int i, int j) {
    const Vec3 n0 = at_start.sign[i] * box_axis(i, pair.a0, pair.b);
    const Vec3 n1 = at_end.sign[j] * box_axis(j, pair.a1, pair.b);
    if (!stays_apart(pair, n0, n1, bulge, sweep, spare)) return false;
    plane = {n0, n1, j >= 3};
    return true;
  };
  return (together >= 0 && try_pair(together, together)) || (at_end.sep[last] > 0 && try_pair(first, last));
}

}  // namespace tegotae
