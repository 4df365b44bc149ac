#include "resolve/metric.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace tegotae {
namespace {

// A needle's inertia about its own axis is nearly nothing; below this share of the largest radius of gyration a turn
// about that axis would count for less than a step of rounding and the program would be badly scaled.
constexpr double kMinRadiusShare = 0.02;

}  // namespace

Metric::Metric(double radius) : radii_(Vec3::Constant(radius)) {}

Metric::Metric(const MassProperties& mass) {
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(mass.inertia / mass.mass);
  axes_ = eigen.eigenvectors();
  radii_ = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  radii_ = radii_.cwiseMax(kMinRadiusShare * radii_.maxCoeff());
  axes_W_ = axes_;
}

}  // namespace tegotae
