#include "coupling/local_model.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <random>

#include "catch.hpp"

using namespace tegotae;

namespace {

Mat3 some_gyration() {
  Mat3 g;
  g << 4e-4, 5e-5, -2e-5, 5e-5, 3e-4, 1e-5, -2e-5, 1e-5, 1e-4;
  return g;
}

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

/// The point nearest to the pen in the mass metric that keeps all planes, by trying every set of active planes:
/// minimize ½ (d - e)ᵀ M (d - e) subject to J d >= -room, in plain world coordinates.
Vec6 brute_force(const ContactPlanes& planes, const Mat3& inertia_W, const Vec3& center_W, const Vec6& e) {
  Eigen::Matrix<double, 6, 6> M = Eigen::Matrix<double, 6, 6>::Identity();
  M.bottomRightCorner<3, 3>() = inertia_W;
  Eigen::MatrixXd J(planes.count, 6);
  Eigen::VectorXd b(planes.count);
  for (int i = 0; i < planes.count; ++i) {
    const ContactPlane& p = planes.planes[static_cast<std::size_t>(i)];
    J.row(i) << p.normal.transpose(), (p.point - center_W).cross(p.normal).transpose();
    b[i] = -p.room;
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

TEST_CASE("at the pen that the tick answered, the part stays where it is", "[coupling]") {
  ProxyState x;
  x.X = {rotation(Vec3(0.1, 0.2, 0.3)), Vec3(0.1, 0, 0)};
  ContactPlanes planes = floor_under(x.X);
  planes.pen = {x.X.q, x.X.p - Vec3(0, 0, 0.003)};
  const Pose before = x.X;
  LocalModel model;
  REQUIRE(model.update(planes, some_gyration(), Vec3::Zero(), planes.pen, {}, x));
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
  REQUIRE(model.update(planes, some_gyration(), Vec3::Zero(), Y, {Vec3(0.1, 0, -0.3), Vec3(0, 0, 1)}, x));
  CHECK((x.X.p - Vec3(0.001, -0.002, 0)).norm() < 1e-12);
  CHECK((x.velocity.v - Vec3(0.1, 0, 0)).norm() < 1e-12);
  CHECK((x.velocity.w - Vec3(0, 0, 1)).norm() < 1e-9);
  // Lifted off, it goes along and no longer touches the floor.
  ProxyState lifted;
  Y.p = Vec3(0, 0, 0.001);
  planes.pen.p.z() = 0;
  REQUIRE(model.update(planes, some_gyration(), Vec3::Zero(), Y, {}, lifted));
  CHECK((lifted.X.p - Y.p).norm() < 1e-12);
  CHECK_FALSE(lifted.touching);
}

TEST_CASE("with room left, the part touches when the room is used up", "[coupling]") {
  LocalModel model;
  ProxyState x;
  ContactPlanes planes = floor_under(x.X);
  for (auto& plane : planes.planes) plane.room = 0.001;
  REQUIRE(model.update(planes, some_gyration(), Vec3::Zero(), {Quat::Identity(), Vec3(0, 0, -0.0005)}, {}, x));
  CHECK_FALSE(x.touching);
  x = {};
  REQUIRE(model.update(planes, some_gyration(), Vec3::Zero(), {Quat::Identity(), Vec3(0, 0, -0.004)}, {}, x));
  CHECK(x.touching);
  CHECK((x.X.p - Vec3(0, 0, -0.001)).norm() < 1e-12);
}

TEST_CASE("the projection is that of every set of planes tried", "[coupling]") {
  std::mt19937 rng(23);
  std::normal_distribution<double> normal;
  const auto random = [&](double size) { return Vec3(size * Vec3(normal(rng), normal(rng), normal(rng))); };
  LocalModel model;
  const Mat3 gyration = some_gyration();
  int moved = 0;
  for (int round = 0; round < 500; ++round) {
    ProxyState x;
    x.X = {rotation(random(1)), random(0.1)};
    const Vec3 center = random(0.02);
    const Vec3 center_W = x.X * center;
    ContactPlanes planes;
    planes.X = x.X;
    planes.count = 1 + round % ContactPlanes::kMost;
    for (int i = 0; i < planes.count; ++i)
      planes.planes[static_cast<std::size_t>(i)] = {random(1).normalized(), center_W + random(0.02),
                                                    std::abs(1e-4 * normal(rng))};
    const Displacement then = {random(2e-3), random(0.03)};
    const Displacement now = {then.dp + random(1e-3), then.dr + random(0.02)};
    planes.pen = displaced(x.X, center, then);
    const Pose Y = displaced(x.X, center, now);
    const Mat3 R = x.X.q.toRotationMatrix();
    const Mat3 inertia = R * gyration * R.transpose();
    Vec6 e_then, e_now;
    e_then << then.dp, then.dr;
    e_now << now.dp, now.dr;
    const Vec6 step = brute_force(planes, inertia, center_W, e_now) - brute_force(planes, inertia, center_W, e_then);
    const Pose expected = displaced(x.X, center, {step.head<3>(), step.tail<3>()});
    REQUIRE(model.update(planes, gyration, center, Y, {}, x));
    const Displacement off = displacement(expected, x.X, center);
    REQUIRE(off.dp.norm() < 1e-9);
    REQUIRE(off.dr.norm() < 1e-7);
    moved += x.touching ? 1 : 0;
  }
  CHECK(moved > 200);
}

TEST_CASE("without planes, or with senseless ones, the part stays", "[coupling]") {
  LocalModel model;
  ProxyState x;
  const Pose Y = {Quat::Identity(), Vec3(0, 0, -0.004)};
  const ContactPlanes good = floor_under(x.X);
  const auto refused = [&](ContactPlanes planes, const Mat3& gyration, const Pose& pen) {
    ProxyState mine;
    const bool updated = model.update(planes, gyration, Vec3::Zero(), pen, {}, mine);
    return !updated && mine.X.p == Vec3::Zero() && !mine.touching;
  };
  CHECK(refused({}, some_gyration(), Y));
  CHECK(refused(good, Mat3::Zero(), Y));
  CHECK(refused(good, -some_gyration(), Y));
  CHECK(refused(good, Mat3::Constant(std::nan("")), Y));
  CHECK(refused(good, some_gyration(), {rotation(Vec3(0, 1, 0)), Vec3::Zero()}));
  ContactPlanes bad = good;
  bad.planes[1].normal *= 1.1;
  CHECK(refused(bad, some_gyration(), Y));
  bad = good;
  bad.planes[1].point.x() = std::nan("");
  CHECK(refused(bad, some_gyration(), Y));
  bad = good;
  bad.planes[2].room = std::nan("");
  CHECK(refused(bad, some_gyration(), Y));
  bad = good;
  bad.count = 7;
  CHECK(refused(bad, some_gyration(), Y));
  // Taken a micrometer, or a hair of a turn, away from where the part is.
  bad = good;
  bad.X.p.x() = 1e-6;
  CHECK(refused(bad, some_gyration(), Y));
  bad = good;
  bad.X.q = rotation(Vec3(0, 0, 1e-9));
  CHECK(refused(bad, some_gyration(), Y));
}
