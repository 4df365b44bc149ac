#pragma once

// Four vectors of three coordinates side by side, for the search of planes between boxes: their products with a normal
// take as long as one of them.

#include <cstdint>

#include "narrowphase/wide.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae {

typedef double Four __attribute__((vector_size(4 * sizeof(double)), may_alias));
typedef std::int64_t FourBits __attribute__((vector_size(4 * sizeof(double)), may_alias));

struct Columns {
  Four x, y, z;

  TEGOTAE_INLINE Vec3 column(int i) const { return {x[i], y[i], z[i]}; }
};

/// Products of `n` with each.
TEGOTAE_INLINE Four dot(const Vec3& n, const Columns& c) {
  return n.x() * c.x + n.y() * c.y + n.z() * c.z;
}
TEGOTAE_INLINE Columns rotated(const Mat3& R, const Columns& c) {
  return {R(0, 0) * c.x + R(0, 1) * c.y + R(0, 2) * c.z, R(1, 0) * c.x + R(1, 1) * c.y + R(1, 2) * c.z,
          R(2, 0) * c.x + R(2, 1) * c.y + R(2, 2) * c.z};
}
TEGOTAE_INLINE Four magnitude(Four v) {
  return (Four)((FourBits)v & 0x7fffffffffffffff);
}
TEGOTAE_INLINE double sum(Four v) {
  return (v[0] + v[2]) + (v[1] + v[3]);
}

}  // namespace tegotae
