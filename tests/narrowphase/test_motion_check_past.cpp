// What a new path certificate proves, one that was asked before proves too, whatever that was about.
#include <array>
#include <string>

#include "broadphase/bounding_spheres.hpp"
#include "catch.hpp"
#include "narrowphase/patch_motion_check.hpp"
#include "patch_scenes.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

/// A layer of needles across each other, as the end faces of parts from CAD are tessellated, but not in one plane.
MeshPtr needles(int count, double size, double thickness) {
  std::mt19937 rng(static_cast<std::mt19937::result_type>(count));
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->name = "needles";
  for (int i = 0; i < count; ++i) {
    const double x = uniform(rng, -size, size), y = uniform(rng, -size, size), z = uniform(rng, 0, thickness);
    const double angle = uniform(rng, 0, kPi);
    const Vec3 along(1.3 * size * std::cos(angle), 1.3 * size * std::sin(angle), 0);
    const Vec3 across(-size / 30 * std::sin(angle), size / 30 * std::cos(angle), 0);
    const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
    for (const Vec3& off : {Vec3(-along), along, across}) {
      const double height = z + uniform(rng, -0.2, 0.2) * thickness;
      mesh->vertices.emplace_back(x + off.x(), y + off.y(), std::clamp(height, 0.0, thickness));
    }
    mesh->triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

struct Case {
  std::string name;
  MeshPtr a, b;
  Vec3 center;
  Pose start;
};

std::vector<Case> cases() {
  std::vector<Case> out;
  for (const int count : {1000, 1500}) {
    const MeshPtr layer = needles(count, 0.015, 2e-4);
    out.push_back({"layers of needles", layer, layer, Vec3::Zero(), {Quat::Identity(), Vec3(0, 0, 1.2e-3)}});
  }
  const MeshPtr sheet = wave(0.1, 0.002, 0.05, 60);
  out.push_back({"waves", sheet, sheet, Vec3::Zero(), {Quat::Identity(), Vec3(0, 0, 5e-4)}});
  out.push_back({"fine peg in a fine hole",
                 peg(0.0098, 0.04, 20000),
                 hole(0.01, 0.04, 20000),
                 Vec3(0, 0, 0.02),
                 {Quat::Identity(), Vec3(0, 0, -0.03)}});
  for (const Scene& s : scenes()) out.push_back({s.name, s.a, s.b, s.center, s.start});
  return out;
}

double power(std::mt19937& rng, double lo, double hi) {
  return std::pow(10, uniform(rng, lo, hi));
}

/// A motion from beside the case's start; or none, which asks about the pose.
struct Question {
  Pose X;
  Displacement d;
};

/// `far` (m) and `turn` (rad): powers of ten by which the pose is off at most.
Question question(std::mt19937& rng, const Case& c, double radius, const std::array<double, 2>& far,
                  const std::array<double, 2>& turn) {
  const double away = 0.02 * power(rng, far[0], far[1]);
  const double turned = power(rng, turn[0], turn[1]);
  Question q;
  q.X = displaced(c.start, c.center, {random_in_ball(rng, away), random_in_ball(rng, turned)});
  if (rng() % 2 == 0) q.d = {random_in_ball(rng, 0.04 * radius), random_in_ball(rng, 0.04)};
  return q;
}

class Checks {
 public:
  explicit Checks(const Case& c) : case_(c), radius_(radius_about(*c.a, c.center)), used_(make()) {
    blocking_.reserve(64);
  }

  double radius() const { return radius_; }
  MotionAnswer fresh(const Question& q, double clearance) {
    const auto check = make();
    return ask(*check, q, clearance);
  }
  MotionAnswer used(const Question& q, double clearance) { return ask(*used_, q, clearance); }

 private:
  std::unique_ptr<PatchMotionCheck> make() const {
    return std::make_unique<PatchMotionCheck>(case_.a, case_.center, radius_, std::vector<MeshPtr>{case_.b},
                                              std::vector<Pose>{Pose{}}, std::vector<std::uint32_t>{});
  }
  MotionAnswer ask(PatchMotionCheck& check, const Question& q, double clearance) {
    blocking_.clear();
    check.begin({0}, kNoDeadline, OtherParts::far);
    return check.check(q.X, q.d, clearance, blocking_);
  }

  const Case& case_;
  double radius_;
  std::unique_ptr<PatchMotionCheck> used_;
  std::vector<FacePair> blocking_;
};

/// Asks for the most clearance that is proved: close to it nearly all pairs of triangles are told apart one by one.
void ask_for_most(Checks& checks, const Question& q) {
  double low = 1e-6, high = 0.3 * checks.radius();
  for (int i = 0; i < 10; ++i) {
    const double middle = std::sqrt(low * high);
    (checks.used(q, middle) == MotionAnswer::free ? low : high) = middle;
  }
}

}  // namespace

TEST_CASE("what was asked before costs no proof", "[patch]") {
  for (const Case& c : cases()) {
    Checks checks(c);
    std::mt19937 rng(7);
    int proved = 0;
    for (int round = 0; round < 3; ++round) {
      for (int i = 0; i < 8; ++i) ask_for_most(checks, question(rng, c, checks.radius(), {-2.5, 0}, {-3, -0.5}));
      for (int i = 0; i < 4; ++i) {
        Question q = question(rng, c, checks.radius(), {-3, -0.5}, {-4, -1});
        if (i == 0) q.X = c.start;
        const double clearance = power(rng, -6, -3);
        if (checks.fresh(q, clearance) != MotionAnswer::free) continue;
        ++proved;
        CAPTURE(c.name, round, i, clearance);
        CHECK(checks.used(q, clearance) == MotionAnswer::free);
      }
    }
    CAPTURE(c.name);
    CHECK(proved > 0);
  }
}
