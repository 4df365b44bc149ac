// Coulomb's law against what is known of it in closed form, against a certificate of its own, and against a slow method
// that shares nothing with the solver.
#include "lp/friction_solver.hpp"

#include <iostream>
#include <random>

#include "alloc_guard.hpp"
#include "catch.hpp"
#include "lp/friction_cases.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr double kDegree = M_PI / 180;
/// Of the wanted motion: how far the convex neighbor is solved.
constexpr double kFine = 1e-10;

/// Whether the part moves at all under the load.
bool sticks(const FrictionCase& c, const Vec6& load) {
  static FrictionSolver solver(FrictionCase::kMax);
  const FrictionResult& r = solver.solve(c.problem(load));
  REQUIRE(r.status == LpStatus::optimal);
  return r.z.norm() < 1e-6 * load.norm();
}

/// The four bottom corners of a block of half width b whose center is h above them.
FrictionCase block(double b, double h, double mu) {
  FrictionCase c;
  for (const double x : {-b, b})
    for (const double y : {-b, b}) c.add({x, y, -h}, Vec3::UnitZ(), mu);
  return c;
}

Vec6 tilted_weight(double weight, double angle) {
  return FrictionCase::load(weight * Vec3(std::sin(angle), 0, -std::cos(angle)));
}

/// A right-hand screw held in a nut that stands still: points on three turns of the flank that carries a load from
/// above, and on the other one, which is 50 µm away.
FrictionCase screw(double pitch, double d2, double mu) {
  const double alpha = 30 * kDegree, lambda = std::atan(pitch / (M_PI * d2));
  FrictionCase c;
  for (int i = 0; i < 36; ++i) {
    const double a = i * 2 * M_PI / 12;
    const Vec3 radial(std::cos(a), std::sin(a), 0), along(-std::sin(a), std::cos(a), 0);
    const double z = pitch * (a / (2 * M_PI) - 1.5);
    const Vec3 rise = Vec3::UnitZ() - std::tan(lambda) * along;
    c.add(0.5 * d2 * radial + Vec3(0, 0, z), rise - std::tan(alpha) * radial, mu);
    c.add(0.5 * d2 * radial + Vec3(0, 0, z + 0.4 * pitch), -(rise + std::tan(alpha) * radial), mu, 5e-5);
  }
  return c;
}

/// A peg of radius r, `depth` deep in its hole without play, tip at `tip` under the center: in the plane, or round with
/// seven points on an arc a contact.
FrictionCase peg(bool round, double r, double depth, double tip, double mu) {
  FrictionCase c;
  const auto contact = [&](double z, double side) {
    if (!round) return c.add({side * r, 0, z}, {-side, 0, 0}, mu);
    for (int i = -3; i <= 3; ++i) {
      const double a = 0.02 * i;
      const Vec3 out(side * std::cos(a), side * std::sin(a), 0);
      c.add(r * out + Vec3(0, 0, z), -out, mu, 1e-3 * r * (1 - std::cos(a)));
    }
  };
  for (const double side : {1.0, -1.0}) {
    contact(-tip, side);
    contact(-tip + depth, side);
  }
  return c;
}

struct Random {
  std::mt19937_64 rng;
  explicit Random(unsigned seed) : rng(seed) {}
  double uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(rng); }
  double normal() { return std::normal_distribution<double>()(rng); }
  Vec3 vector() { return {normal(), normal(), normal()}; }
};

enum class Kind { movable, rings, any, flat };

/// A part of 5 mm to 0.1 m pulled by 2 mm and 0.1 rad into contacts of one kind.
Vec6 random_case(Random& u, Kind kind, int contacts, double mu, FrictionCase& c) {
  c.clear();
  const double size = std::exp(u.uniform(std::log(0.005), std::log(0.1))), depth = size * u.uniform(0.2, 2);
  const Vec3 free = u.vector(), turn = u.vector() / FrictionCase::radius();
  for (int i = 0; i < contacts; ++i) {
    Vec3 r = size * Vec3(u.uniform(-1, 1), u.uniform(-1, 1), u.uniform(-1, 1)), n = u.vector().normalized();
    if (kind == Kind::rings) {
      const double a = u.uniform(0, 2 * M_PI);
      n = -Vec3(std::cos(a), std::sin(a), 0);
      r = -size * n + Vec3(0, 0, u.uniform(0, 1) < 0.5 ? depth : 0);
    }
    if (kind == Kind::flat) r.z() = -depth, n = Vec3::UnitZ();
    if (kind == Kind::movable && n.dot(free + turn.cross(r)) < 0) n = -n;
    c.add(r, n, mu, u.uniform(0, 1) < 0.6 ? 0 : -20e-6 * std::log(u.uniform(1e-9, 1)));
  }
  Vec6 wanted;
  wanted << 2e-3 * u.vector(), FrictionCase::radius() * 0.1 * u.vector();
  if (kind == Kind::flat) wanted[2] = -std::abs(wanted[2]);
  return wanted;
}

/// Contacts taken in turn, each solved by itself by damped projections, until nothing changes: slow, and of another
/// kind than the solver. False when it has not settled.
bool gauss_seidel(const FrictionProblem& p, Vec6& z) {
  const int n = p.normals.rows();
  std::vector<Vec3> force(static_cast<std::size_t>(n), Vec3::Zero());
  z = p.wanted;
  const double settled = 1e-10 * p.wanted.norm();
  for (int sweep = 0; sweep < 100000; ++sweep) {
    double change = 0;
    for (int i = 0; i < n; ++i) {
      Eigen::Matrix<double, 3, 6> J;
      J << p.normals.row(i).transpose(), p.tangents[i].row[0].transpose(), p.tangents[i].row[1].transpose();
      Vec3& f = force[static_cast<std::size_t>(i)];
      const double weight = (J * J.transpose()).trace();
      Vec3 u = J * z;
      u[0] += p.mu[i] * u.tail<2>().norm() - p.bounds[i];
      Vec3 next = f - u / weight;
      const double t = next.tail<2>().norm(), mu = p.mu[i];
      if (mu * t <= -next[0]) {
        next.setZero();
      } else if (t > mu * next[0]) {
        next[0] = (next[0] + mu * t) / (1 + mu * mu);
        next.tail<2>() *= mu * next[0] / t;
      }
      const Vec6 moved = J.transpose() * (next - f);
      z += moved;
      f = next;
      change = std::max(change, moved.norm());
    }
    if (change < settled) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("a block on a plane slides at mu and tips at its edge", "[friction]") {
  for (const double mu : {0.1, 0.3, 0.5, 0.8}) {
    const FrictionCase c = block(0.02, 0.005, mu);
    const double angle = threshold(0, 1.5, [&](double a) { return sticks(c, tilted_weight(3, a)); });
    CHECK(std::tan(angle) == Approx(mu).epsilon(1e-4));
  }
  const FrictionCase high = block(0.01, 0.05, 0.8);
  const double tips = threshold(0, 1.5, [&](double a) { return sticks(high, tilted_weight(3, a)); });
  CHECK(std::tan(tips) == Approx(0.01 / 0.05).epsilon(1e-4));
  // It turns about the edge, which does not slip.
  FrictionSolver solver(FrictionCase::kMax);
  const FrictionResult& r = solver.solve(high.problem(tilted_weight(3, 0.3)));
  const FrictionProblem p = high.problem(tilted_weight(3, 0.3));
  CHECK(r.exact);
  CHECK(std::abs(r.z[4]) > 1e-4 * FrictionCase::radius());
  for (const FrictionForce& f : r.forces) CHECK(std::abs(p.tangents[f.row].row[0].dot(r.z)) < 1e-9);
}

TEST_CASE("friction while a block slides on a plane is mu N in every direction", "[friction]") {
  FrictionSolver solver(FrictionCase::kMax);
  for (const double mu : {0.05, 0.3, 0.8})
    for (int i = 0; i < 24; ++i) {
      const double a = (i + 0.3) * 2 * M_PI / 24;
      const FrictionCase c = block(0.02, 0.004, mu);
      const Vec6 wanted = FrictionCase::load({4 * std::cos(a), 4 * std::sin(a), -2});
      const FrictionResult& r = solver.solve(c.problem(wanted));
      REQUIRE(r.exact);
      const Vec6 pull = FrictionCase::kStiffness * (wanted - r.z);
      CHECK(pull.head<2>().norm() / (mu * 2) == Approx(1).epsilon(1e-6));
      CHECK(pull.z() == Approx(-2).epsilon(1e-6));
      CHECK(std::abs(r.z[0] * std::sin(a) - r.z[1] * std::cos(a)) < 1e-9);  // it goes where it is pulled
      CHECK(std::abs(r.z[2]) < 1e-9);                                       // and does not lift
    }
}

TEST_CASE("V-groove, collar and spin stick up to their closed forms", "[friction]") {
  for (const double half : {20.0, 45.0, 60.0}) {
    const double a = half * kDegree, mu = 0.3;
    FrictionCase c;
    for (const double y : {-0.02, 0.02})
      for (const double s : {-1.0, 1.0}) c.add({0.005 * s, y, 0}, {-s * std::cos(a), 0, std::sin(a)}, mu);
    const double force = threshold(0, 60, [&](double f) { return sticks(c, FrictionCase::load({0, f, -4})); });
    CHECK(force == Approx(mu * 4 / std::sin(a)).epsilon(1e-3));
  }
  for (const double mu : {0.1, 0.3, 0.6}) {
    // A collar of length L on a post, pushed down beside the axis: from L / 2 mu on it holds whatever the force.
    const double length = 0.03;
    FrictionCase c;
    for (const double z : {-0.5 * length, 0.5 * length})
      for (const double s : {-1.0, 1.0}) c.add({0.01 * s, 0, z}, {s, 0, 0}, mu);
    const double arm = threshold(0, 1, [&](double x) {
      return !sticks(c, FrictionCase::load({0, 0, -5}, {0, 5 * x, 0}));
    });
    CHECK(arm == Approx(length / (2 * mu)).epsilon(1e-3));
  }
  FrictionCase c;
  for (int i = 0; i < 4; ++i) {
    const double a = 0.3 + i * M_PI / 2;
    c.add({0.01 * std::cos(a), 0.01 * std::sin(a), -0.01}, Vec3::UnitZ(), 0.3);
  }
  const double spin = threshold(0, 1, [&](double t) { return sticks(c, FrictionCase::load({0, 0, -5}, {0, 0, t})); });
  CHECK(spin == Approx(0.3 * 0.01 * 5).epsilon(1e-3));
}

TEST_CASE("a flat ring spins at the friction of its whole face", "[friction]") {
  const double inner = 0.005, outer = 0.01, mu = 0.3;
  FrictionCase c;
  double sum = 0;
  for (int j = 0; j < 4; ++j) {
    const double r = std::sqrt(inner * inner + (j + 0.5) / 4 * (outer * outer - inner * inner));
    sum += r / 4;
    for (int i = 0; i < 16; ++i) {
      const double a = i * 2 * M_PI / 16;
      c.add({r * std::cos(a), r * std::sin(a), -0.01}, Vec3::UnitZ(), mu);
    }
  }
  const double spin = threshold(0, 1, [&](double t) { return sticks(c, FrictionCase::load({0, 0, -5}, {0, 0, t})); });
  CHECK(spin == Approx(mu * 5 * sum).epsilon(1e-3));  // the load is shared by all 64 points
  const double whole = 2.0 / 3 * (std::pow(outer, 3) - std::pow(inner, 3)) / (outer * outer - inner * inner);
  CHECK(spin == Approx(mu * 5 * whole).epsilon(0.01));
}

TEST_CASE("a loaded screw holds itself from tan(lead) cos(flank) on, and turns at its torques", "[friction]") {
  for (const auto& thread : {std::pair(2e-3, 14.701e-3), {2.5e-3, 18.376e-3}}) {
    const double pitch = thread.first, d2 = thread.second;
    const double lambda = std::atan(pitch / (M_PI * d2));
    const double flank = std::atan(std::tan(30 * kDegree) * std::cos(lambda));
    const double critical = std::tan(lambda) * std::cos(flank);
    const double found = threshold(0, 0.2, [&](double mu) {
      return !sticks(screw(pitch, d2, mu), FrictionCase::load({0, 0, -5}));
    });
    CHECK(found == Approx(critical).epsilon(0.002));
    for (const double mu : {0.1, 0.2}) {
      const FrictionCase c = screw(pitch, d2, mu);
      const double phi = std::atan(mu / std::cos(flank)), arm = 5 * d2 / 2;
      const double up = threshold(0, 0.2, [&](double t) {
        return sticks(c, FrictionCase::load({0, 0, -5}, {0, 0, t}));
      });
      const double down = threshold(0, 0.2, [&](double t) {
        return sticks(c, FrictionCase::load({0, 0, -5}, {0, 0, -t}));
      });
      CHECK(up == Approx(arm * std::tan(phi + lambda)).epsilon(0.002));
      CHECK(down == Approx(arm * std::tan(phi - lambda)).epsilon(0.002));
    }
  }
}

TEST_CASE("a peg in two-point contact jams where Whitney says", "[friction]") {
  const bool round = GENERATE(false, true);
  const double r = 0.005, tip = 0.02, push = 2;
  int right = 0, all = 0;
  for (const double lambda : {0.5, 1.0, 2.0})
    for (const double mu : {0.1, 0.3}) {
      const FrictionCase c = peg(round, r, 2 * r * mu * lambda, tip, mu);
      for (int i = 0; i < 40; ++i)
        for (int j = 0; j < 40; ++j) {
          const double side = (-1.5 + 3 * (i + 0.5) / 40) / mu,
                       moment = (-1.3 + 2.6 * (j + 0.5) / 40) * (1 + 2 * lambda);
          const Vec3 force(side * push, 0, -push);
          const Vec3 torque = Vec3(0, -moment * r * push, 0) + Vec3(0, 0, -tip).cross(force);
          const bool slides = std::abs(side) < 1 / mu && std::abs(moment + mu * (1 + lambda) * side) < lambda;
          right += slides != sticks(c, FrictionCase::load(force, torque));
          ++all;
        }
    }
  std::cout << (round ? "round" : "planar") << " peg: " << right << " of " << all << " points as Whitney has them\n";
  CHECK(right >= 0.99 * all);
}

TEST_CASE("what is said to be exact obeys the law, what is not still keeps every limit and loses energy",
          "[friction]") {
  const double mu = GENERATE(0.1, 0.3, 0.8);
  const int contacts = GENERATE(1, 2, 5, 8, 20, 64);
  CAPTURE(mu, contacts);
  Random u(static_cast<unsigned>(100 * mu) + contacts);
  FrictionSolver solver(FrictionCase::kMax);
  FrictionCase c;
  int exact = 0, all = 0;
  for (const Kind kind : {Kind::movable, Kind::rings, Kind::any, Kind::flat})
    for (int i = 0; i < 200; ++i) {
      const Vec6 wanted = random_case(u, kind, contacts, mu, c);
      const FrictionProblem p = c.problem(wanted);
      const FrictionResult& r = solver.solve(p);
      REQUIRE(r.status == LpStatus::optimal);
      const LawError e = law_error(p, r.z, r.forces);
      const double size = wanted.norm();
      REQUIRE(e.overlap <= 1e-6 * size);
      REQUIRE(e.cone <= 1e-6 * size);
      // What of the springs' energy is not left went into contacts, none came out of them.
      REQUIRE(r.z.dot(wanted) >= r.z.squaredNorm() - 1e-7 * size * size);
      if (r.exact) REQUIRE(e.worst() <= 2e-6 * size);
      if (!r.exact) REQUIRE(e.direction > 0);
      exact += r.exact;
      ++all;
    }
  // What this hard set had, less a tenth.
  CHECK(exact >= 0.7 * all);
}

TEST_CASE("on a face, where there is one answer, a slow method finds the same", "[friction]") {
  Random u(7);
  FrictionSolver solver(FrictionCase::kMax);
  FrictionCase c;
  int same = 0, compared = 0;
  for (int i = 0; i < 120; ++i) {
    const Vec6 wanted = random_case(u, Kind::flat, 3 + i % 4, 0.1 + 0.1 * (i % 3), c);
    const FrictionResult& r = solver.solve(c.problem(wanted));
    Vec6 slow;
    if (!r.exact || !gauss_seidel(c.problem(wanted), slow)) continue;
    ++compared;
    same += (slow - r.z).norm() < 1e-4 * wanted.norm();
  }
  std::cout << same << " of " << compared << " motions on faces as by Gauss and Seidel\n";
  CHECK(compared >= 100);
  CHECK(same >= 0.98 * compared);
}

TEST_CASE("the convex neighbor has one answer, wherever the search for it starts", "[friction]") {
  Random u(31);
  RelaxedCone cone(FrictionCase::kMax);
  FrictionCase c;
  for (int i = 0; i < 300; ++i) {
    const Vec6 wanted = random_case(u, static_cast<Kind>(i % 4), 4 + i % 60, 0.1 + 0.1 * (i % 6), c);
    const FrictionProblem p = c.problem(wanted);
    cone.set_problem(p);
    REQUIRE(cone.solve(p.bounds, kFine));
    const Vec6 z = cone.z();
    std::vector<FrictionForce> right, wrong;
    cone.forces(right);
    for (int k = 0; k < 8; ++k) {
      const double nu = std::abs(u.normal()), angle = u.uniform(0, 2 * M_PI), t = u.uniform(0, 1.2) * p.mu[0] * nu;
      wrong.push_back({static_cast<int>(u.uniform(0, c.size())), nu, {t * std::cos(angle), t * std::sin(angle)}, true});
    }
    for (const auto& start : {right, wrong}) {
      REQUIRE(cone.solve(p.bounds, kFine, start));
      // Limits that hold to 1e-10 leave the nearest motion open to the root of that.
      CHECK((cone.z() - z).norm() < 1e-4 * wanted.norm());
      for (int k = 0; k < c.size(); ++k) {
        const TangentRows& t = p.tangents[k];
        const double slip = std::hypot(t.row[0].dot(cone.z()), t.row[1].dot(cone.z()));
        CHECK(p.normals.row(k).dot(cone.z()) - p.mu[k] * slip >= p.bounds[k] - 1e-7 * wanted.norm());
      }
    }
  }
}

TEST_CASE("from a guess, good or bad, comes nothing that breaks the law", "[friction]") {
  Random u(32);
  FrictionSolver solver(FrictionCase::kMax);
  FrictionCase c;
  std::vector<FrictionForce> last;
  int exact = 0, count = 0, repeated = 0, with_forces = 0;
  for (int i = 0; i < 400; ++i) {
    const Vec6 wanted = random_case(u, static_cast<Kind>(i % 4), 4 + i % 60, 0.1 + 0.1 * (i % 6), c);
    const FrictionProblem p = c.problem(wanted);
    // The forces of another problem.
    std::vector<FrictionForce> guess;
    for (const FrictionForce& f : last)
      if (f.row < c.size()) guess.push_back(f);
    const FrictionResult& r = solver.solve(p, guess);
    REQUIRE(r.status == LpStatus::optimal);
    ++count;
    exact += r.exact;
    if (r.exact) CHECK(law_error(p, r.z, r.forces).worst() < 1e-6 * wanted.norm());
    last = r.forces;
    if (!r.exact || last.empty()) continue;
    // Its own forces lead back to it, unless others hold the part too. When all contacts began as sticking 378 of 398
    // did.
    ++with_forces;
    const Vec6 z = r.z;
    const FrictionResult& again = solver.solve(p, last);
    repeated += again.exact && (again.z - z).norm() < 1e-6 * wanted.norm();
  }
  std::cout << exact << " of " << count << " exact from a bad guess, " << repeated << " of " << with_forces
            << " the same from their own forces\n";
  CHECK(exact >= 0.9 * count);
  CHECK(repeated >= 0.99 * with_forces);
}

TEST_CASE("without friction the answer is that of the least distance, bit for bit", "[friction]") {
  Random u(8);
  FrictionSolver solver(FrictionCase::kMax);
  LeastDistanceSolver plain(FrictionCase::kMax);
  FrictionCase c;
  for (int i = 0; i < 400; ++i) {
    const Vec6 wanted = random_case(u, static_cast<Kind>(i % 4), 1 + i % 40, 0, c);
    const FrictionProblem p = c.problem(wanted);
    const FrictionResult& r = solver.solve(p);
    const QpResult& q = plain.solve(p.normals, p.bounds, wanted);
    REQUIRE(r.z == q.z);
    REQUIRE(static_cast<int>(r.forces.size()) == q.multipliers.count);
    for (int k = 0; k < q.multipliers.count; ++k)
      REQUIRE(r.forces[static_cast<std::size_t>(k)].normal == q.multipliers.value[static_cast<std::size_t>(k)]);
  }
}

TEST_CASE("a peg whose cones overlap is held neither where it can go on nor where it is pulled", "[friction]") {
  // Shallow: each of the two points lies in the other's cone, so that sticking would obey the law too.
  const double mu = 0.3, r = 0.005;
  const FrictionCase c = peg(false, r, r * mu, 0.02, mu);
  CHECK(!sticks(c, FrictionCase::load({0, 0, -2})));
  CHECK(!sticks(c, FrictionCase::load({0, 0, 2})));
}

TEST_CASE("input that is not a number ends without a motion", "[friction]") {
  FrictionSolver solver(FrictionCase::kMax);
  FrictionCase c = block(0.02, 0.005, 0.3);
  Vec6 wanted = tilted_weight(3, 1);
  wanted[2] = std::nan("");
  const FrictionResult& r = solver.solve(c.problem(wanted));
  CHECK(r.status == LpStatus::stalled);
  CHECK(r.z.isZero());
  CHECK(r.forces.empty());
  // And with nothing that touches, or nothing wanted, there is no friction.
  c.clear();
  CHECK(solver.solve(c.problem(tilted_weight(3, 1))).z == tilted_weight(3, 1));
  const FrictionResult& rest = solver.solve(block(0.02, 0.005, 0.3).problem(Vec6::Zero()));
  CHECK(rest.status == LpStatus::optimal);
  CHECK(rest.z.isZero());
}

TEST_CASE("solving allocates nothing and takes a bounded number of rounds", "[friction]") {
  Random u(9);
  FrictionSolver solver(FrictionCase::kMax);
  std::vector<FrictionCase> cases(40);
  std::vector<Vec6> wanted;
  for (std::size_t i = 0; i < cases.size(); ++i)
    wanted.push_back(random_case(u, static_cast<Kind>(i % 4), i % 2 == 0 ? 20 : 120, 0.3, cases[i]));
  int most = 0;
  std::uint64_t allocations = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const FrictionProblem p = cases[i].problem(wanted[i]);
    const AllocGuard guard;
    most = std::max(most, solver.solve(p).iterations);
    allocations += guard.count();
  }
  CHECK(allocations == 0);
  CHECK(most < 400 + 2 * 26 + 301);
}

TEST_CASE("out of time a solve has no answer, or the guess whose contacts touch", "[friction]") {
  Random u(17);
  FrictionSolver solver(FrictionCase::kMax), other(FrictionCase::kMax);
  FrictionCase c;
  int with_force = 0;
  for (int i = 0; i < 100; ++i) {
    const Vec6 wanted = random_case(u, static_cast<Kind>(i % 4), 4 + i % 60, 0.3, c);
    const FrictionProblem in_time = c.problem(wanted);
    FrictionProblem late = in_time;
    late.deadline_ns = 1;
    const FrictionResult& whole = other.solve(in_time);
    const std::vector<FrictionForce> guess = whole.forces;
    const FrictionResult& r = solver.solve(late);
    if (r.method != FrictionMethod::frictionless) {
      CHECK(r.method == FrictionMethod::late);
      CHECK(r.status == LpStatus::stalled);
      CHECK_FALSE(r.exact);
      CHECK(r.z.isZero());
      CHECK(r.forces.empty());
    }
    if (guess.empty()) continue;
    const FrictionResult& kept = solver.solve(late, guess);
    CHECK(kept.method == FrictionMethod::late);
    CHECK(kept.status == LpStatus::optimal);
    std::vector<FrictionForce> touching;
    for (const FrictionForce& f : guess)
      if (late.bounds[f.row] == 0) touching.push_back(f);
    with_force += touching.empty() ? 0 : 1;
    REQUIRE(kept.forces.size() == touching.size());
    for (std::size_t k = 0; k < touching.size(); ++k) CHECK(kept.forces[k].row == touching[k].row);
    // Each within its cone, and what they do not hold is the motion.
    const LawError e = law_error(late, kept.z, kept.forces);
    CHECK(e.balance < 1e-12);
    CHECK(e.cone < 1e-9);
  }
  CHECK(with_force > 50);
  // A deadline that does not pass changes nothing.
  for (int i = 0; i < 100; ++i) {
    const Vec6 wanted = random_case(u, static_cast<Kind>(i % 4), 4 + i % 60, 0.3, c);
    FrictionProblem far = c.problem(wanted);
    far.deadline_ns = kNoDeadline - 1;
    CHECK(solver.solve(far).z == other.solve(c.problem(wanted)).z);
  }
}
