// What the hand feels of contacts that stay as they are is the gradient of an energy: over closed loops of the pen it
// gives the hand nothing, and it changes by no more than the springs' stiffness times what the pen moves.
#include <cmath>
#include <iostream>
#include <random>

#include "catch.hpp"
#include "coupling/local_model.hpp"
#include "tegotae/coupling/stability.hpp"

using namespace tegotae;

namespace {

constexpr int kSteps = 20000;  // a loop; a step is under a micrometer and 50 µrad

/// A smooth closed curve of pen poses about the pose of the part, into its contacts and out.
class Loop {
 public:
  Loop(std::mt19937& rng, double shift, double turn) {
    std::normal_distribution<double> normal;
    for (auto& wave : waves_)
      for (int i = 0; i < 6; ++i) wave[i] = (i < 3 ? shift : turn) * normal(rng);
  }
  Displacement at(double s) const {
    const double a = 2 * M_PI * s;
    const Vec6 d = waves_[0] * std::cos(a) + waves_[1] * std::sin(a) + 0.5 * waves_[2] * std::cos(2 * a) +
                   0.5 * waves_[3] * std::sin(2 * a) + waves_[4];
    return {d.head<3>(), d.tail<3>()};
  }

 private:
  Vec6 waves_[5];
};

ContactPlanes random_planes(std::mt19937& rng, int count, double size, const Vec3& center_W) {
  std::normal_distribution<double> normal;
  const auto random = [&] { return Vec3(normal(rng), normal(rng), normal(rng)).normalized(); };
  ContactPlanes planes;
  planes.count = count;
  for (int i = 0; i < count; ++i)
    planes.planes[static_cast<std::size_t>(i)] = {random(), center_W + size * random(), std::abs(2e-4 * normal(rng))};
  return planes;
}

struct Worst {
  double work = 0, change = 0, force = 0;
  int refused = 0;
};

/// Leads the pen once around; what it costs the hand, and how fast the wrench changes, by K.
void lead(const Loop& loop, ContactPlanes planes, const CouplingSettings& k, const Pose& X, const Vec3& center,
          Worst& worst) {
  LocalModel model;
  const double radius = coupling_radius(k);
  Wrench last;
  Pose last_Y;
  double work = 0;
  bool known = true;
  for (int i = 0; i <= kSteps && known; ++i) {
    const Pose Y = displaced(X, center, loop.at(static_cast<double>(i % kSteps) / kSteps));
    planes.pen = Y;
    planes.X = X;
    ProxyState x;
    x.X = X;
    known = model.update(planes, radius, center, Y, {}, x);
    x.touching = true;
    const Wrench w = coupling_wrench({k.stiffness, 0, k.torsional_stiffness, 0}, x, Y, {}, center);
    worst.force = std::max(worst.force, w.force.norm());
    if (i > 0) {
      const Displacement moved = displacement(last_Y, Y, center);
      work -= 0.5 * ((w.force + last.force).dot(moved.dp) + (w.torque + last.torque).dot(moved.dr));
      const double pen = std::hypot(moved.dp.norm(), radius * moved.dr.norm());
      const double change = std::hypot((w.force - last.force).norm(), (w.torque - last.torque).norm() / radius);
      worst.change = std::max(worst.change, change / (k.stiffness * pen));
    }
    last = w;
    last_Y = Y;
  }
  if (!known) ++worst.refused;
  if (known) worst.work = std::max(worst.work, std::abs(work));
}

}  // namespace

TEST_CASE("closed loops of the pen around frozen contacts cost the hand nothing", "[coupling][law]") {
  std::mt19937 rng(71);
  Worst worst;
  // Parts of 2 mm to half a meter, with one to six contacts, held by the default springs and by those that fit.
  const double sizes[] = {0.002, 0.01, 0.05, 0.5};
  int loops = 0;
  for (int round = 0; round < 48; ++round) {
    const double size = sizes[round % 4];
    CouplingSettings k;
    if (round % 8 >= 4) k.torsional_stiffness = fitted_torsional_stiffness(k.stiffness, size, 18);
    const Vec3 center(0.3 * size, -0.2 * size, 0.1 * size);
    const Pose X = {rotation(Vec3(0.3, -0.5, 0.2) * round), Vec3(0.1, 0.2, -0.1)};
    const double turn = std::min(0.05, 2e-3 / size);
    lead(Loop(rng, 1e-3, turn), random_planes(rng, 1 + round % 6, size, X * center), k, X, center, worst);
    ++loops;
  }
  std::cout << loops << " loops, forces up to " << worst.force << " N: work " << worst.work
            << " J at most, the wrench changes by " << worst.change << " K |dY| at most\n";
  CHECK(worst.refused < loops / 4);
  CHECK(worst.force > 1);
  CHECK(worst.work < 1e-9);
  // With turns of a tenth of a radian the distance to the pen is not that of a flat space.
  CHECK(worst.change < 1.01);
}

TEST_CASE("the torsional stiffness fits the part, within what is felt and what is stable", "[coupling]") {
  CHECK(fitted_torsional_stiffness(800, 0.002, 18) == 0.3);
  CHECK(fitted_torsional_stiffness(800, 0.05, 18) == Approx(2));
  CHECK(fitted_torsional_stiffness(800, 0.5, 18) == 18);
  CHECK(fitted_torsional_stiffness(800, 0.5, 0.1) == 0.3);
  CHECK(torsional_stiffness_bound(72, 0.188) == Approx(3.76));
  CHECK(torsional_stiffness_bound(4, 0.188) == Approx(2));
  CHECK(torsional_stiffness_bound(0, 0.188) == 0.3);
  CHECK(torsional_stiffness_bound(std::nullopt, 0.188) == 0.3);
  CHECK(coupling_radius({800, 5, 0.32, 0}) == Approx(0.02));
  CHECK(coupling_radius({800, 5, 0.32, 0}, 3) == Approx(0.06));
  for (const CouplingSettings& k : {CouplingSettings{0, 0, 0, 0}, CouplingSettings{0, 0, 1, 0}, {1, 0, 0, 0}})
    CHECK((coupling_radius(k) >= 1e-4 && coupling_radius(k) <= 10));
}
