#pragma once

#include "narrowphase/patch_separate.hpp"
#include "patch_oracle.hpp"
#include "patch_scenes.hpp"

namespace tegotae::test {

using RealMat = Eigen::Matrix<long double, 3, 3>;

/// A random motion of A past B, and where A is on both readings of its path.
struct Motion {
  Pose X;
  Vec3 center, origin_b;
  Displacement d;
  Sweep sweep;
  double size;  ///< m, of the parts

  Motion(std::mt19937& rng, const PatchTree& b) : origin_b(b.origin()), size(std::pow(10.0, uniform(rng, -3, -0.5))) {
    center = random_in_ball(rng, 2 * size);
    X = Pose{rotation(random_in_ball(rng, 3)), random_in_ball(rng, 3 * size)};
    const double length = std::pow(10.0, uniform(rng, -5, -0.5));
    d = {random_in_ball(rng, length * size), random_in_ball(rng, std::pow(10.0, uniform(rng, -5, -0.5)))};
    if (rng() % 8 == 0) d.dr.setZero();
    if (rng() % 8 == 0) d.dp.setZero();
    sweep = Sweep(X, d, center, b, size, 0);
  }

  struct At {
    RealMat R;
    Real3 center;  ///< of mass, from the origin of B's tree
  };
  At at(long double s, bool by_origin) const {
    const long double angle = d.dr.cast<long double>().norm();
    RealMat turn = RealMat::Identity();
    if (angle > 0) {
      const Real3 axis = d.dr.cast<long double>() / angle;
      turn = Eigen::AngleAxis<long double>(s * angle, axis).toRotationMatrix();
    }
    const Real3 c0 = X.p.cast<long double>() + R0() * center.cast<long double>();
    Real3 c = c0 + s * d.dp.cast<long double>();
    if (by_origin) {
      RealMat whole = RealMat::Identity();
      if (angle > 0)
        whole = Eigen::AngleAxis<long double>(angle, Real3(d.dr.cast<long double>() / angle)).toRotationMatrix();
      const Real3 c1 = c0 + d.dp.cast<long double>(), arm = R0() * center.cast<long double>();
      const Real3 p0 = c0 - arm, p1 = c1 - whole * arm;
      c = p0 + s * (p1 - p0) + turn * arm;
    }
    return {turn * R0(), c - origin_b.cast<long double>()};
  }

 private:
  RealMat R0() const { return X.q.cast<long double>().normalized().toRotationMatrix(); }
};

}  // namespace tegotae::test
