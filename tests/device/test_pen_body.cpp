#include <cmath>

#include "catch.hpp"
#include "device/pen_body.hpp"

using namespace tegotae;

namespace {

constexpr double kStep = 5e-5;
const PenTarget kOrigin{Vec3::Zero(), Quat::Identity(), {}};

/// Displacement at `t` of mass m, spring k, damper d under a constant force f from rest at 0; under-damped.
double step_response(double m, double k, double d, double f, double t) {
  const double w0 = std::sqrt(k / m);
  const double z = d / (2 * std::sqrt(k * m));
  const double wd = w0 * std::sqrt(1 - z * z);
  return f / k * (1 - std::exp(-z * w0 * t) * (std::cos(wd * t) + z * w0 / wd * std::sin(wd * t)));
}

}  // namespace

TEST_CASE("a constant wrench gives the step response of a damped oscillator", "[device]") {
  const double friction = 0;
  const PenBodySettings s{0.375, Vec3::Constant(3e-4), 400, 6, 1.5, 0.01, friction};
  PenBody body;
  const Vec3 axis = Vec3(1, -2, 2) / 3;
  const Wrench wrench{2.0 * Vec3(0, 0.6, 0.8), 0.1 * axis};
  double worst_x = 0;
  double worst_angle = 0;
  for (int i = 1; i <= 10'000; ++i) {
    body.step(kStep, s, kOrigin, wrench);
    const double x = step_response(0.375, 400, 6, 2.0, i * kStep);
    const double angle = step_response(3e-4, 1.5, 0.01, 0.1, i * kStep);
    worst_x = std::max(worst_x, (body.center - x * Vec3(0, 0.6, 0.8)).norm());
    worst_angle = std::max(worst_angle, (rotation_vector(body.rotation) - angle * axis).norm());
  }
  // The largest excursions are 9 mm and 0.12 rad; the rule's phase error is (w h)^2 / 12 a radian.
  CHECK(worst_x < 1e-7);
  CHECK(worst_angle < 5e-6);
}

TEST_CASE("an undamped spring keeps its energy", "[device]") {
  const PenBodySettings s{0.2, Vec3::Constant(2e-4), 2000, 0, 2, 0, 0};
  PenBody body;
  body.center = Vec3(0.01, 0, 0);
  body.rotation = Quat(Eigen::AngleAxisd(0.5, Vec3::UnitY()));
  const auto energy = [&] {
    return 0.1 * body.velocity.squaredNorm() + 1000 * body.center.squaredNorm() +
           0.5 * body.angular_momentum.squaredNorm() / 2e-4 + rotation_vector(body.rotation).squaredNorm();
  };
  const double before = energy();
  // At 1 ms, twenty times the device's own step, and for 20 s.
  for (int i = 0; i < 20'000; ++i) body.step(1e-3, s, kOrigin, {});
  CHECK(energy() == Approx(before).epsilon(1e-3));
}

TEST_CASE("a free symmetric top precesses about its angular momentum", "[device]") {
  const double across = 2e-4;
  const double along = 0.5e-4;
  const PenBodySettings s{0.1, Vec3(across, across, along), 0, 0, 0, 0, 0};
  PenBody body;
  body.angular_momentum = Vec3(1.0e-3, 0, 2.0e-3);
  body.velocity = Vec3(0.1, 0.2, 0.3);
  const Vec3 L = body.angular_momentum;
  const double T = 0.5;
  for (int i = 0; i < 10'000; ++i) body.step(T / 10'000, s, kOrigin, {});
  CHECK(body.angular_momentum == L);
  CHECK((body.center - T * Vec3(0.1, 0.2, 0.3)).norm() < 1e-12);
  const Vec3 expected = Eigen::AngleAxisd(L.norm() / across * T, L.normalized()) * Vec3::UnitZ();
  CHECK((body.rotation * Vec3::UnitZ() - expected).norm() < 1e-5);
  const Vec3 w = body.angular_velocity(s);
  const double energy = 0.5 * (1.0e-3 * 1.0e-3 / across + 2.0e-3 * 2.0e-3 / along);
  CHECK(0.5 * w.dot(L) == Approx(energy).epsilon(1e-6));
}

TEST_CASE("friction stops a sliding pen where Coulomb's law says, and holds it", "[device]") {
  const PenBodySettings s{0.3, Vec3::Constant(1e-4), 0, 0, 0, 0, 0.04};
  PenBody body;
  body.velocity = Vec3(0.06, 0.08, 0);
  const double stop_time = 0.3 * 0.1 / 0.04;
  for (double t = 0; t < stop_time - 2 * kStep; t += kStep) body.step(kStep, s, kOrigin, {});
  CHECK(body.velocity.norm() > 0);
  for (int i = 0; i < 10; ++i) body.step(kStep, s, kOrigin, {});
  CHECK(body.velocity.norm() == 0);
  CHECK(body.center.norm() == Approx(0.3 * 0.1 * 0.1 / (2 * 0.04)).epsilon(1e-4));
  const Vec3 stuck = body.center;
  for (int i = 0; i < 100; ++i) body.step(kStep, s, kOrigin, {Vec3(0, 0.0399, 0), Vec3::Zero()});
  CHECK(body.center == stuck);
  body.step(kStep, s, kOrigin, {Vec3(0, 0.0401, 0), Vec3::Zero()});
  CHECK(body.center.y() > stuck.y());
}

TEST_CASE("a constant force on a free pen gives it that momentum", "[device]") {
  const PenBodySettings s{0.3, Vec3(1e-4, 2e-4, 3e-4), 0, 0, 0, 0, 0};
  PenBody body;
  const Wrench wrench{Vec3(1, -2, 0.5), Vec3(1e-4, 2e-4, -3e-4)};
  for (int i = 0; i < 2000; ++i) body.step(1e-4, s, kOrigin, wrench);
  CHECK((0.3 * body.velocity - 0.2 * wrench.force).norm() < 1e-12);
  CHECK((body.center - 0.5 * 0.04 / 0.3 * wrench.force).norm() < 1e-12);
  CHECK((body.angular_momentum - 0.2 * wrench.torque).norm() < 1e-15);
}
