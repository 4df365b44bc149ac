#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "lp/friction_solver.hpp"

namespace tegotae::test {

/// A friction problem that owns its rows: contacts at points about the center of mass, in the coordinates of the
/// coupling's default springs, so that a wanted motion stands for a load in N and N·m.
class FrictionCase {
 public:
  static constexpr int kMax = 128;
  static constexpr double kStiffness = 800, kTorsional = 0.3;
  static double radius() { return std::sqrt(kTorsional / kStiffness); }

  FrictionCase() : normals_(kMax) {}

  void clear() {
    normals_.clear();
    tangents_.clear();
    bounds_.clear();
    mu_.clear();
  }
  /// `gap` (m): what the contact may close.
  void add(const Vec3& point, const Vec3& normal, double mu, double gap = 0) {
    const Vec3 n = normal.normalized();
    const Vec3 other = std::abs(n.x()) < 0.6 ? Vec3::UnitX() : Vec3::UnitY();
    const Vec3 a = n.cross(other).normalized();
    normals_.push_row(row(point, n));
    tangents_.push_back({{row(point, a), row(point, n.cross(a))}});
    bounds_.push_back(-gap);
    mu_.push_back(mu);
  }
  FrictionProblem problem(const Vec6& wanted) const {
    return {normals_, bounds_.data(), tangents_.data(), mu_.data(), wanted};
  }
  int size() const { return normals_.rows(); }

  /// The wanted motion of springs that pull with this force and torque about the center of mass.
  static Vec6 load(const Vec3& force, const Vec3& torque = Vec3::Zero()) {
    Vec6 z;
    z << force / kStiffness, torque / (kStiffness * radius());
    return z;
  }

 private:
  static Vec6 row(const Vec3& point, const Vec3& e) {
    Vec6 r;
    r << e, point.cross(e) / radius();
    return r;
  }

  LowRankMatrix normals_;
  std::vector<TangentRows> tangents_;
  std::vector<double> bounds_, mu_;
};

/// How far an answer is from Coulomb's law, told from the contacts' forces and slips one by one: m, and joules by the
/// stiffness for the work.
struct LawError {
  double balance = 0, overlap = 0, open = 0, cone = 0, direction = 0;
  double worst() const { return std::max({balance, overlap, open, cone, direction}); }
};

inline LawError law_error(const FrictionProblem& p, const Vec6& z, const std::vector<FrictionForce>& forces) {
  LawError e;
  Vec6 rest = z - p.wanted;
  for (int i = 0; i < p.normals.rows(); ++i) e.overlap = std::max(e.overlap, p.bounds[i] - p.normals.row(i).dot(z));
  for (const FrictionForce& f : forces) {
    const Vec6 n = p.normals.row(f.row);
    const TangentRows& t = p.tangents[f.row];
    const double mu = p.mu[f.row], friction = std::hypot(f.tangential[0], f.tangential[1]);
    rest -= f.normal * n + f.tangential[0] * t.row[0] + f.tangential[1] * t.row[1];
    e.cone = std::max({e.cone, -f.normal, friction - mu * f.normal});
    e.open = std::max(e.open, n.dot(z) - p.bounds[f.row]);
    // Of all frictions in the cone it is the one that dissipates most: τ · slip = -μ ν |slip|.
    const double s0 = t.row[0].dot(z), s1 = t.row[1].dot(z), slip = std::hypot(s0, s1);
    const double lost = f.tangential[0] * s0 + f.tangential[1] * s1 + mu * f.normal * slip;
    e.direction = std::max(e.direction, std::abs(lost) / p.wanted.norm());
  }
  e.balance = rest.norm();
  return e;
}

/// Where `holds` turns from true (at `low`) to false (at `high`).
inline double threshold(double low, double high, const std::function<bool(double)>& holds) {
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (holds(middle) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace tegotae::test
