#include <cmath>
#include <random>

#include "bodies.hpp"
#include "catch.hpp"
#include "tegotae/core/pose.hpp"

using namespace tegotae;
using namespace tegotae::test;

TEST_CASE("rotation vectors and quaternions are inverse of each other", "[core]") {
  std::mt19937 rng(1);
  for (double size : {1e-12, 1e-9, 1e-7, 1e-3, 1.0, 1.7}) {
    for (int i = 0; i < 100; ++i) {
      const Vec3 r = random_vector(rng, size);
      const Mat3 expected = r.norm() > 0 ? Mat3(Eigen::AngleAxisd(r.norm(), r.normalized())) : Mat3(Mat3::Identity());
      REQUIRE((rotation(r).toRotationMatrix() - expected).norm() < 1e-14);
      REQUIRE((rotation_vector(rotation(r)) - r).norm() < 1e-14 + 1e-12 * r.norm());
    }
  }
}

TEST_CASE("displacement undoes displaced about any center", "[core]") {
  std::mt19937 rng(2);
  for (int i = 0; i < 200; ++i) {
    const Pose X{rotation(random_vector(rng, 2.0)), random_vector(rng, 1.0)};
    const Vec3 c = random_vector(rng, 0.3);
    const Displacement d{random_vector(rng, 0.1), random_vector(rng, 1.0)};
    const Pose Y = displaced(X, c, d);
    const Displacement e = displacement(X, Y, c);
    REQUIRE((e.dp - d.dp).norm() < 1e-14);
    REQUIRE((e.dr - d.dr).norm() < 1e-13);
    // The center moved by dp, another point turned about it.
    const Vec3 b = random_vector(rng, 0.3);
    const Vec3 expected = X * c + d.dp + Eigen::AngleAxisd(d.dr.norm(), d.dr.normalized()) * (X * b - X * c);
    REQUIRE((Y * b - expected).norm() < 1e-14);
  }
}

TEST_CASE("poses compose and invert", "[core]") {
  std::mt19937 rng(3);
  for (int i = 0; i < 100; ++i) {
    const Pose A{rotation(random_vector(rng, 2.0)), random_vector(rng, 1.0)};
    const Pose B{rotation(random_vector(rng, 2.0)), random_vector(rng, 1.0)};
    const Vec3 p = random_vector(rng, 1.0);
    REQUIRE(((A * B) * p - A * (B * p)).norm() < 1e-14);
    REQUIRE((A.inverse() * (A * p) - p).norm() < 1e-14);
  }
}
