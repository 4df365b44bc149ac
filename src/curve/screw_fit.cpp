#include "curve/screw_fit.hpp"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <cmath>

namespace tegotae {
namespace {

/// Weight of the velocity itself among the squares: it decides only what the facets leave open.
constexpr double kMinVelocity = 1e-7;

/// Sums of the squares Σ w (n · c_bar + (x × n) · c)², x from the weighted middle, which makes both parts alike.
struct Squares {
  Mat3 velocity = Mat3::Zero(), mixed = Mat3::Zero(), turn = Mat3::Zero();
  Vec3 middle = Vec3::Zero();
  double weight = 0, distance2 = 0;

  Squares(const std::vector<Facet>& facets, const std::vector<std::size_t>& of, const std::vector<double>& w,
          const ScrewMotion* near, const std::vector<double>* rise) {
    const auto place = [near](const Facet& f) { return near == nullptr ? f.center : chord_middle(f, *near); };
    for (std::size_t i = 0; i < of.size(); ++i) {
      middle += w[i] * place(facets[of[i]]);
      weight += w[i];
    }
    if (!(weight > 0)) return;
    middle /= weight;
    for (std::size_t i = 0; i < of.size(); ++i) {
      const Facet& f = facets[of[i]];
      const Vec3 x = place(f) - middle, m = x.cross(f.normal) + (rise == nullptr ? 0.0 : (*rise)[i]) * f.normal;
      velocity += w[i] * f.normal * f.normal.transpose();
      mixed += w[i] * f.normal * m.transpose();
      turn += w[i] * m * m.transpose();
      distance2 += w[i] * x.squaredNorm();
    }
    velocity /= weight;
    mixed /= weight;
    turn /= weight;
    distance2 /= weight;
    velocity += kMinVelocity * Mat3::Identity();
  }
};

}  // namespace

ScrewFit fit_screw(const std::vector<Facet>& facets, const std::vector<std::size_t>& of,
                   const std::vector<double>& weight, const ScrewMotion* near, const std::vector<double>* rise) {
  ScrewFit fit;
  const Squares s(facets, of, weight, near, rise);
  if (!(s.weight > 0) || !(s.distance2 > 0)) return fit;
  const Mat3 inverse = s.velocity.inverse();
  const Mat3 rest = s.turn - s.mixed.transpose() * inverse * s.mixed;
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(0.5 * (rest + rest.transpose()));
  const Vec3 c = eigen.eigenvectors().col(0);
  if (!c.allFinite()) return fit;
  fit.motion.c = c.normalized();
  fit.motion.c_bar = -inverse * (s.mixed * fit.motion.c);
  fit.motion.c_bar -= fit.motion.c.cross(s.middle);  // from the middle of the facets to the origin
  fit.best = eigen.eigenvalues()[0] / s.distance2;
  fit.second = eigen.eigenvalues()[1] / s.distance2;
  fit.found = fit.motion.c_bar.allFinite();
  return fit;
}

ScrewMotion without_rise(const std::vector<Facet>& facets, const std::vector<std::size_t>& of,
                         const std::vector<double>& weight, const ScrewMotion& motion) {
  Squares s(facets, of, weight, &motion, nullptr);
  ScrewMotion out = motion;
  // A rise costs more than anything.
  const Mat3 along = motion.c * motion.c.transpose();
  s.velocity = (Mat3::Identity() - along) * s.velocity * (Mat3::Identity() - along) + along;
  Vec3 c_bar = -s.velocity.inverse() * ((Mat3::Identity() - along) * (s.mixed * motion.c));
  c_bar -= motion.c * motion.c.dot(c_bar);
  out.c_bar = c_bar - motion.c.cross(s.middle);
  out.c_bar -= motion.c * motion.c.dot(out.c_bar);
  return out;
}

}  // namespace tegotae
