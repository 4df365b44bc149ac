// A block pressed straight down on a thin post beside its middle. Without friction it can only hand on what the post
// exerts: a force at the place of the post that is nearest to its center, along the face that lies on it.
#include <algorithm>
#include <cmath>

#include "bodies.hpp"
#include "catch.hpp"
#include "loop/pen_run.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

const Vec3 kBlock(0.014, 0.011, 0.009), kPost(0.007, 0.007, 0.03);

struct Post {
  Scene scene;
  Quat turn;   ///< of the post about the vertical; its top is at z = 0
  Vec3 start;  ///< of the block's center
};

Post block_over_post(std::mt19937& rng) {
  Post p;
  std::uniform_real_distribution<double> unit(-1, 1);
  p.turn = rotation({0, 0, 3 * unit(rng)});
  const Quat heading = rotation({0, 0, 3 * unit(rng)});
  // The block's bottom covers some of the top, and the top at most part of it.
  p.start = Vec3(5e-3 * unit(rng), 5e-3 * unit(rng), 0.5 * kBlock.z() + 4e-4);
  p.scene.contact.tick_budget = INFINITY;
  p.scene.max_torsional_stiffness = kMaxTorsional;
  p.scene.parts = {{"post", shared(box(kPost)), {p.turn, {0, 0, -0.5 * kPost.z()}}},
                   {"block", shared(box(kBlock)), {heading, p.start}, true}};
  return p;
}

/// The place of the post's top that is nearest to `p`.
Vec3 nearest_on_top(const Post& post, const Vec3& p) {
  Vec3 at = post.turn.conjugate() * p;
  for (int k = 0; k < 2; ++k) at[k] = std::clamp(at[k], -0.5 * kPost[k], 0.5 * kPost[k]);
  at.z() = 0;
  return post.turn * at;
}

}  // namespace

TEST_CASE("a block on a post feels the post's force at its place, and none aside that turns round", "[law][post]") {
  const double seconds = GENERATE(0.3, 1.5);  // on the way
  int beside = 0, above = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    CAPTURE(seconds, seed);
    std::mt19937 rng(seed);
    const Post post = block_over_post(rng);
    const Quat q = post.scene.parts.back().pose.q;
    const Pose below{q, post.start - Vec3(0, 0, 4e-3)};
    PenRun hand(post.scene, StylusScript({{0, post.scene.parts.back().pose}, {seconds, below}}));
    double aside = 0, step = 0, round = 0;
    PenSample pen;
    Vec3 last = Vec3::Zero(), change = Vec3::Zero();
    for (int tick = 0; tick < 1000 * seconds + 900; ++tick) {
      pen = hand.tick();
      const Vec3 force = pen.wrench.force;
      // Along the block's face and along the vertical between which contacts push: aside by the tilt's sine at most.
      const double tilt = (hand.loop.latest().q * q.conjugate() * Vec3::UnitZ()).head<2>().norm();
      aside = std::max(aside, force.head<2>().norm() - tilt * force.norm());
      const Vec3 changed = force - last;
      step = std::max(step, changed.head<2>().norm());
      round = std::max({round, -changed.x() * change.x(), -changed.y() * change.y()});
      change = changed;
      last = force;
    }
    const Vec3 center = hand.loop.latest() * hand.loop.center();
    const Vec3 arm = nearest_on_top(post, center) - center, force = pen.wrench.force;
    CAPTURE(arm.transpose(), force.transpose(), pen.wrench.torque.transpose());
    CHECK(force.z() > 0.4);
    CHECK(aside < 0.01);
    CHECK(step < 0.01);
    CHECK(std::sqrt(round) < 0.005);
    // Over the post nothing turns it: the force goes through the center. Near the rim it may be either.
    const double over = arm.head<2>().norm();
    if (over > 5e-4) CHECK((pen.wrench.torque - arm.cross(force)).norm() < 0.03 * arm.norm() * force.norm());
    if (over < 1e-9) CHECK(pen.wrench.torque.norm() < 1e-4 * force.norm());
    CHECK(pen.wrench.torque.norm() < 1.03 * force.norm() * 0.5 * kBlock.norm());
    beside += over > 5e-4 ? 1 : 0;
    above += over < 1e-9 ? 1 : 0;
  }
  CHECK(beside > 3);
  CHECK(above > 1);
}
