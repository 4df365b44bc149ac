#pragma once

#include "bench/contact_programs.hpp"

namespace tegotae::test {

using namespace tegotae::programs;

/// `points` points on one face of a box on a floor, all normals up.
inline Contacts coplanar(Random& random, int points) {
  Contacts c;
  for (int i = 0; i < points; ++i) {
    const bool corner = i < 4;
    const double x = corner ? (i % 2 ? 0.03 : -0.03) : random.uniform(-0.03, 0.03);
    const double y = corner ? (i / 2 ? 0.02 : -0.02) : random.uniform(-0.02, 0.02);
    c.add(Vec3::UnitZ(), Vec3(x, y, -0.01), 0);
  }
  return c;
}

/// Normals within `spread` rad of one direction, and of its opposite when `opposed`.
inline Contacts near_parallel(Random& random, int points, double spread, bool opposed) {
  Contacts c;
  const Vec3 axis = random.direction();
  for (int i = 0; i < points; ++i) {
    const double side = opposed && i % 2 ? -1 : 1;
    const Vec3 n = (side * axis + spread * random.direction()).normalized();
    c.add(n, 0.03 * random.direction(), random.integer(0, 1) ? 0 : random.uniform(0, 1e-4));
  }
  return c;
}

/// A box with corners of half sizes `h` held by `planes` half-spaces that touch it: every corner is a contact of each.
inline Contacts wedged_box(Random& random, int planes, const Vec3& h) {
  Contacts c;
  for (int p = 0; p < planes; ++p) {
    const Vec3 n = random.direction();
    double lowest = 1;
    for (int k = 0; k < 8; ++k) {
      const Vec3 corner(k & 1 ? h.x() : -h.x(), k & 2 ? h.y() : -h.y(), k & 4 ? h.z() : -h.z());
      lowest = std::min(lowest, n.dot(corner));
    }
    for (int k = 0; k < 8; ++k) {
      const Vec3 corner(k & 1 ? h.x() : -h.x(), k & 2 ? h.y() : -h.y(), k & 4 ? h.z() : -h.z());
      c.add(n, corner, n.dot(corner) - lowest);
    }
  }
  return c;
}

/// A round peg of `facets` facets that leans by `tilt` (rad) between the rim of its hole and the wall at its tip, with
/// gaps of at most `clearance` all around.
inline Contacts leaning_peg(Random& random, int facets, double tilt, double clearance) {
  Contacts c;
  const double rim = -0.025 + random.uniform(0.001, 0.02);
  for (int f = 0; f < facets; ++f) {
    const double angle = 2 * M_PI * f / facets;
    const Vec3 out(std::cos(angle), std::sin(angle), 0);
    const Vec3 leaning = Eigen::AngleAxisd(tilt, Vec3::UnitY()) * out;
    c.add(-leaning, 0.01 * out + Vec3(0, 0, rim), random.uniform(0, clearance));
    c.add(-out, 0.01 * leaning + Vec3(0, 0, -0.025), random.uniform(0, clearance));
  }
  return c;
}

/// Contact-like programs of many kinds; all have an answer, by the lemma of section 3.
inline Program held_body(Random& random, int kind) {
  const double l_min = std::pow(10.0, random.uniform(-6, -4));
  const Vec6 delta = wanted(random);
  Body body;
  switch (kind % 8) {
    case 0:
      return program(coplanar(random, 4), body, delta, l_min);
    case 1:
      return program(coplanar(random, 50), body, delta, l_min);
    case 2:
      return program(near_parallel(random, random.integer(2, 40), std::pow(10.0, random.uniform(-9, -1)), false), body,
                     delta, l_min);
    case 3:
      return program(near_parallel(random, random.integer(2, 40), std::pow(10.0, random.uniform(-7, -1)), true), body,
                     delta, l_min);
    case 4:
      return program(peg(random, 64, random.integer(1, 8), 1e-4), body, delta, l_min);
    case 5:
      return program(wedged_box(random, random.integer(2, 6), Vec3(0.01, 0.02, 0.03)), body, delta, l_min);
    case 6: {  // exact duplicates
      Contacts c = wedged_box(random, 3, Vec3(0.02, 0.02, 0.02));
      for (std::size_t i = 0, n = c.gap.size(); i < n; ++i) {
        c.add(c.normal[i], c.arm[i], c.gap[i]);
      }
      return program(c, body, delta, l_min);
    }
    default: {  // any contacts at all, the body of any size
      Contacts c;
      const double size = std::pow(10.0, random.uniform(-3, 0));
      body.mass = std::pow(10.0, random.uniform(-4, 1));
      body.radius = size * Vec3(random.uniform(0.1, 1), random.uniform(0.1, 1), random.uniform(0.1, 1));
      for (int i = random.integer(1, 100); i > 0; --i) {
        c.add(random.direction(), size * random.uniform(0, 3) * random.direction(),
              random.integer(0, 1) ? 0 : random.uniform(0, 1e-3));
      }
      return program(c, body, delta, l_min);
    }
  }
}

/// Small programs without structure, half of them with whole-number data (ties everywhere); many have no answer.
inline Program small(Random& random, int rows) {
  Program p;
  p.g.resize(rows, 6);
  p.d.resize(rows);
  const bool whole = random.integer(0, 1);
  const int rank = random.integer(1, 6);
  for (int i = 0; i < rows; ++i) {
    for (int k = 0; k < 6; ++k) {
      p.g(i, k) = k >= rank ? 0 : whole ? random.integer(-1, 1) : random.normal();
    }
    p.d[i] = whole ? random.integer(-2, 2) : random.normal();
  }
  return p;
}

/// Whether `y` proves that no x has G x >= d: y >= 0, dᵀ y > 0, and Gᵀ y as good as zero, so that an x would have to
/// be `times` longer than the largest distance from 0 to one row's half-space.
inline bool proves_infeasible(const Program& p, const Eigen::VectorXd& y, double times) {
  double farthest = 0;
  for (int i = 0; i < p.g.rows(); ++i) {
    const double length = p.g.row(i).norm();
    farthest = std::max(farthest, length > 0 ? p.d[i] / length : 0);
  }
  const double gain = p.d.dot(y);
  return y.size() > 0 && y.minCoeff() >= 0 && gain > 0 && (p.g.transpose() * y).norm() * times * farthest <= gain;
}

/// Sparse multipliers as a vector of n.
template <class Sparse>
Eigen::VectorXd dense(const Sparse& s, Eigen::Index n) {
  Eigen::VectorXd v = Eigen::VectorXd::Zero(n);
  for (int k = 0; k < s.count; ++k) {
    v[s.index[k]] += s.value[k];
  }
  return v;
}

}  // namespace tegotae::test
