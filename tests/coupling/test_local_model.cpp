#include "coupling/local_model.hpp"

#include <Eigen/LU>
#include <random>

#include "catch.hpp"

using namespace tegotae;

namespace {

constexpr double kRadius = 0.019;  // m, coupling_radius() of the defaults is 19.4 mm

ContactPlanes floor_under(const Pose& X) {
  ContactPlanes planes;
  planes.X = X;
  int i = 0;
  for (double x : {-0.01, 0.01})
    for (double y : {-0.01, 0.01})
      planes.planes[static_cast<std::size_t>(i++)] = {Vec3::UnitZ(), X.p + Vec3(x, y, -0.02), 0};
  planes.count = i;
  return planes;
}

/// The point nearest to the pen in the springs' metric that keeps all planes, by trying every set of active planes:
/// minimize ½ (d - e)ᵀ M (d - e) subject to J d >= -room, in plain world coordinates.
Vec6 brute_force(const ContactPlanes& planes, double radius, const Vec3& center_W, const Vec6& e) {
  Eigen::Matrix<double, 6, 6> M = Eigen::Matrix<double, 6, 6>::Identity();
  M.bottomRightCorner<3, 3>() *= radius * radius;
  Eigen::MatrixXd J(planes.count, 6);
  Eigen::VectorXd b(planes.count);
  for (int i = 0; i < planes.count; ++i) {
    const ContactPlane& p = planes.planes[static_cast<std::size_t>(i)];
    J.row(i) << p.normal.transpose(), (p.point - center_W).cross(p.normal).transpose();
    b[i] = -p.clearance;
  }
  Vec6 best = Vec6::Constant(std::nan(""));
  double least = 1e300;
  for (int set = 0; set < 1 << planes.count; ++set) {
    std::vector<int> rows;
    for (int i = 0; i < planes.count; ++i)
      if (set >> i & 1) rows.push_back(i);
    const auto n = static_cast<Eigen::Index>(rows.size());
    Eigen::MatrixXd Ja(n, 6);
    Eigen::VectorXd ba(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      Ja.row(k) = J.row(rows[static_cast<std::size_t>(k)]);
      ba[k] = b[rows[static_cast<std::size_t>(k)]];
    }
    Vec6 d = e;
    if (n > 0) {
      const Eigen::MatrixXd S = Ja * M.inverse() * Ja.transpose();
      const Eigen::FullPivLU<Eigen::MatrixXd> lu(S);
      if (lu.rank() < n) continue;
      d += M.inverse() * Ja.transpose() * lu.solve(ba - Ja * e);
    }
    if (planes.count > 0 && (J * d - b).minCoeff() < -1e-10) continue;
    const double objective = (d - e).dot(M * (d - e));
    if (objective < least) {
      least = objective;
      best = d;
    }
  }
  return best;
}

}  // namespace

TEST_CASE("where the springs' energy is least already, the part stays where it is", "[coupling]") {
  ProxyState x;
  x.X = {rotation(Vec3(0.1, 0.2, 0.3)), Vec3(0.1, 0, 0)};
  ContactPlanes planes = floor_under(x.X);
  planes.pen = {x.X.q, x.X.p - Vec3(0, 0, 0.003)};
  const Pose before = x.X;
  LocalModel model;
  REQUIRE(model.update(planes, kRadius, Vec3::Zero(), planes.pen, {}, x));
  CHECK((x.X.p - before.p).norm() < 1e-15);
  CHECK((x.X.q.coeffs() - before.q.coeffs()).norm() < 1e-15);
  CHECK(x.touching);
  CHECK(x.velocity.v.norm() < 1e-15);
}

TEST_CASE("on a floor the part follows the pen along it and not into it", "[coupling]") {
  ProxyState x;
  ContactPlanes planes = floor_under(x.X);
  planes.pen.p.z() = -0.003;
  Pose Y = planes.pen;
  Y.p += Vec3(0.001, -0.002, -0.0005);
  LocalModel model;
  REQUIRE(model.update(planes, kRadius, Vec3::Zero(), Y, {Vec3(0.1, 0, -0.3), Vec3(0, 0, 1)}, x));
  CHECK((x.X.p - Vec3(0.001, -0.002, 0)).norm() < 1e-12);
  CHECK((x.velocity.v - Vec3(0.1, 0, 0)).norm() < 1e-12);
  CHECK((x.velocity.w - Vec3(0, 0, 1)).norm() < 1e-9);
  // Lifted off, it goes along and no longer touches the floor.
  ProxyState lifted;
  Y.p = Vec3(0, 0, 0.001);
  planes.pen.p.z() = 0;
  REQUIRE(model.update(planes, kRadius, Vec3::Zero(), Y, {}, lifted));
  CHECK((lifted.X.p - Y.p).norm() < 1e-12);
  CHECK_FALSE(lifted.touching);
}

TEST_CASE("with room left, the part touches when the room is used up", "[coupling]") {
  LocalModel model;
  ProxyState x;
  ContactPlanes planes = floor_under(x.X);
  for (auto& plane : planes.planes) plane.clearance = 0.001;
  REQUIRE(model.update(planes, kRadius, Vec3::Zero(), {Quat::Identity(), Vec3(0, 0, -0.0005)}, {}, x));
  CHECK_FALSE(x.touching);
  x = {};
  REQUIRE(model.update(planes, kRadius, Vec3::Zero(), {Quat::Identity(), Vec3(0, 0, -0.004)}, {}, x));
  CHECK(x.touching);
  CHECK((x.X.p - Vec3(0, 0, -0.001)).norm() < 1e-12);
}

namespace {

struct RandomCase {
  ProxyState x;
  Vec3 center;
  ContactPlanes planes;
  Pose Y;
  Displacement error;  ///< from x.X to Y
};

RandomCase random_case(std::mt19937& rng, int count, double turn) {
  std::normal_distribution<double> normal;
  const auto random = [&](double size) { return Vec3(size * Vec3(normal(rng), normal(rng), normal(rng))); };
  RandomCase c;
  c.x.X = {rotation(random(1)), random(0.1)};
  c.center = random(0.02);
  const Vec3 center_W = c.x.X * c.center;
  c.planes.X = c.x.X;
  c.planes.count = count;
  for (int i = 0; i < count; ++i)
    c.planes.planes[static_cast<std::size_t>(i)] = {random(1).normalized(), center_W + random(0.02),
                                                    std::abs(1e-4 * normal(rng))};
  c.error = {random(2e-3), random(turn)};
  c.Y = displaced(c.x.X, c.center, c.error);
  c.planes.pen = c.Y;
  return c;
}

}  // namespace

TEST_CASE("for small turns the answer is that of every set of planes tried", "[coupling]") {
  std::mt19937 rng(23);
  LocalModel model;
  int touched = 0;
  for (int round = 0; round < 500; ++round) {
    RandomCase c = random_case(rng, 1 + round % ContactPlanes::kMax, 1e-4);
    // A shift of a millimeter turns a part on one corner by 0.05 rad: all of it so small that flat is exact.
    c.error.dp *= 1e-3;
    for (auto& plane : c.planes.planes) plane.clearance *= 1e-3;
    c.Y = displaced(c.x.X, c.center, c.error);
    Vec6 e;
    e << c.error.dp, c.error.dr;
    const Vec6 step = brute_force(c.planes, kRadius, c.x.X * c.center, e);
    const Pose expected = displaced(c.x.X, c.center, {step.head<3>(), step.tail<3>()});
    REQUIRE(model.update(c.planes, kRadius, c.center, c.Y, {}, c.x));
    const Displacement off = displacement(expected, c.x.X, c.center);
    REQUIRE(off.dp.norm() < 1e-9);
    REQUIRE(off.dr.norm() < 1e-7);
    touched += c.x.touching ? 1 : 0;
  }
  CHECK(touched > 200);
}

TEST_CASE("for large turns no neighbor that the planes allow stores less energy", "[coupling]") {
  std::mt19937 rng(29);
  std::normal_distribution<double> normal;
  LocalModel model;
  const double ks[] = {1, kRadius * kRadius};
  const auto energy = [&](const RandomCase& c, const Vec6& d) {
    const Displacement left = displacement(displaced(c.x.X, c.center, {d.head<3>(), d.tail<3>()}), c.Y, c.center);
    return 0.5 * (ks[0] * left.dp.squaredNorm() + ks[1] * left.dr.squaredNorm());
  };
  int touched = 0;
  for (int round = 0; round < 500; ++round) {
    RandomCase c = random_case(rng, 1 + round % ContactPlanes::kMax, 0.1);
    const Vec3 center_W = c.x.X * c.center;
    ProxyState x = c.x;
    if (!model.update(c.planes, kRadius, c.center, c.Y, {}, x)) continue;  // it would turn too far
    const Displacement made = displacement(c.x.X, x.X, c.center);
    Vec6 z;
    z << made.dp, made.dr;
    touched += x.touching ? 1 : 0;
    const double least = energy(c, z);
    for (int k = 0; k < 200; ++k) {
      Vec6 near = z;
      for (int i = 0; i < 6; ++i) near[i] += (i < 3 ? 1e-6 : 5e-5) * normal(rng);
      bool allowed = true;
      for (int i = 0; i < c.planes.count; ++i) {
        const ContactPlane& p = c.planes.planes[static_cast<std::size_t>(i)];
        allowed &= p.normal.dot(near.head<3>() + near.tail<3>().cross(p.point - center_W)) >= -p.clearance;
      }
      if (allowed) REQUIRE(energy(c, near) > least - 1e-17);
    }
  }
  CHECK(touched > 200);
}

TEST_CASE("without planes, or with senseless ones, the part stays", "[coupling]") {
  LocalModel model;
  ProxyState x;
  const Pose Y = {Quat::Identity(), Vec3(0, 0, -0.004)};
  const ContactPlanes good = floor_under(x.X);
  const auto refused = [&](ContactPlanes planes, double radius, const Pose& pen) {
    ProxyState mine;
    const bool updated = model.update(planes, radius, Vec3::Zero(), pen, {}, mine);
    return !updated && mine.X.p == Vec3::Zero() && !mine.touching;
  };
  CHECK(refused({}, kRadius, Y));
  CHECK(refused(good, 0, Y));
  CHECK(refused(good, -kRadius, Y));
  CHECK(refused(good, std::nan(""), Y));
  CHECK(refused(good, kRadius, {rotation(Vec3(0, 1, 0)), Vec3::Zero()}));
  ContactPlanes bad = good;
  bad.planes[1].normal *= 1.1;
  CHECK(refused(bad, kRadius, Y));
  bad = good;
  bad.planes[1].point.x() = std::nan("");
  CHECK(refused(bad, kRadius, Y));
  bad = good;
  bad.planes[2].clearance = std::nan("");
  CHECK(refused(bad, kRadius, Y));
  bad = good;
  bad.count = 7;
  CHECK(refused(bad, kRadius, Y));
  // Taken a micrometer, or a hair of a turn, away from where the part is.
  bad = good;
  bad.X.p.x() = 1e-6;
  CHECK(refused(bad, kRadius, Y));
  bad = good;
  bad.X.q = rotation(Vec3(0, 0, 1e-9));
  CHECK(refused(bad, kRadius, Y));
}
