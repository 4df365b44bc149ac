#pragma once

#include "tegotae/core/latency_histogram.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae {

/// Between the arrays of shm.h and the library's types.
inline void store(const Vec3& v, double (&out)[3]) noexcept {
  for (int i = 0; i < 3; ++i) out[i] = v[i];
}
inline void store(const Quat& q, double (&out)[4]) noexcept {
  out[0] = q.w();
  out[1] = q.x();
  out[2] = q.y();
  out[3] = q.z();
}
inline void store(const LatencySummary& s, double (&out)[4]) noexcept {
  out[0] = s.p50;
  out[1] = s.p99;
  out[2] = s.p999;
  out[3] = s.max;
}
inline Vec3 vector(const double (&in)[3]) noexcept {
  return {in[0], in[1], in[2]};
}
inline Quat quaternion(const double (&in)[4]) noexcept {
  return {in[0], in[1], in[2], in[3]};
}
inline LatencySummary latencies(const double (&in)[4]) noexcept {
  return {in[0], in[1], in[2], in[3]};
}

}  // namespace tegotae
