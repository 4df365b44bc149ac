#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tegotae/lp/low_rank_matrix.hpp"

/// Contact programs from random numbers, for the benchmark and the tests of the solvers.
namespace tegotae::programs {

/// Dense data of one program: rows of G, and d.
struct Program {
  Eigen::Matrix<double, Eigen::Dynamic, 6> g;
  Eigen::VectorXd d;

  LowRankMatrix matrix() const {
    LowRankMatrix m(static_cast<int>(g.rows()));
    for (int i = 0; i < g.rows(); ++i) {
      m.push_row(g.row(i).transpose());
    }
    return m;
  }
};

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(engine_); }
  double normal() { return std::normal_distribution<double>()(engine_); }
  int integer(int lo, int hi) { return std::uniform_int_distribution<int>(lo, hi)(engine_); }
  Vec3 direction() { return Vec3(normal(), normal(), normal()).normalized(); }
  Vec6 vec6() {
    Vec6 v;
    for (int k = 0; k < 6; ++k) {
      v[k] = normal();
    }
    return v;
  }

 private:
  std::mt19937_64 engine_;
};

/// A body's contacts: unit normals (towards the body), points from its center, gaps.
struct Contacts {
  std::vector<Vec3> normal, arm;
  std::vector<double> gap;

  void add(const Vec3& n, const Vec3& r, double g) {
    normal.push_back(n);
    arm.push_back(r);
    gap.push_back(g);
  }
};

/// Mass (kg) and principal radii of gyration (m) of the held body.
struct Body {
  double mass = 0.1;
  Vec3 radius = Vec3(0.02, 0.02, 0.03);

  Vec6 inverse_root() const {
    const double s = 1 / std::sqrt(mass);
    return (Vec6() << s, s, s, s / radius.x(), s / radius.y(), s / radius.z()).finished();
  }
};

/// G and d of section 3 of the design: d = min(l_min, gap) - gap - J Δ, Δ in m and rad.
inline Program program(const Contacts& c, const Body& body, const Vec6& delta, double l_min) {
  const auto n = static_cast<Eigen::Index>(c.gap.size());
  Program p;
  p.g.resize(n, 6);
  p.d.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    Vec6 j;
    j << c.normal[k], c.arm[k].cross(c.normal[k]);
    p.g.row(i) = j.cwiseProduct(body.inverse_root()).transpose();
    p.d[i] = std::min(l_min, c.gap[k]) - c.gap[k] - j.dot(delta);
  }
  return p;
}

/// A wanted motion of up to about 1 mm and 20 mrad.
inline Vec6 wanted(Random& random) {
  const double length = std::pow(10.0, random.uniform(-6, -3));
  const double angle = std::pow(10.0, random.uniform(-5, -1.7));
  Vec6 delta;
  delta << length * random.direction(), angle * random.direction();
  return delta;
}

/// A peg (radius 10 mm, length 40 mm) of `facets` facets, touching or almost touching its hole all around, in `rings`
/// heights.
inline Contacts peg(Random& random, int facets, int rings, double clearance) {
  Contacts c;
  for (int ring = 0; ring < rings; ++ring) {
    for (int f = 0; f < facets; ++f) {
      const double angle = 2 * M_PI * f / facets;
      const Vec3 out(std::cos(angle), std::sin(angle), 0);
      const double z = rings > 1 ? -0.02 + 0.04 * ring / (rings - 1) : 0;
      c.add(-out, 0.01 * out + Vec3(0, 0, z), random.integer(0, 2) ? random.uniform(0, clearance) : 0);
    }
  }
  return c;
}

/// `points` points on a ball with random normals, no two alike.
inline Contacts ball(Random& random, int points) {
  Contacts c;
  for (int i = 0; i < points; ++i) {
    const Vec3 n = random.direction();
    c.add(n, 0.03 * random.direction(), random.integer(0, 1) ? 0 : random.uniform(0, 1e-3));
  }
  return c;
}

}  // namespace tegotae::programs
