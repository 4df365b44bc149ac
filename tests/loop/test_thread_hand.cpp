// A nut on its bolt in a hand that means it no good: hammering along the axis and pulling askew at 0.5 m/s. It never
// gets through a flank. Virtual time.
#include <algorithm>
#include <cmath>
#include <random>

#include "catch.hpp"
#include "models/threaded.hpp"
#include "session/pose_check.hpp"
#include "tegotae/loop/haptic_loop.hpp"

using namespace tegotae;

namespace {

constexpr double kPi = 3.14159265358979323846, kPeriod = 1e-3, kSpeed = 0.5;

struct Threaded {
  Scene scene;
  double pitch = 0, play = 0;
  Vec3 start = Vec3(0, 0, 0.008);
};

Threaded nut_on_bolt() {
  Threaded t;
  shapes::Bolt bolt;
  bolt.thread.segments = 60;
  bolt.thread.rows = 2;
  shapes::Nut nut;
  nut.thread = bolt.thread;
  t.pitch = bolt.thread.pitch;
  t.play = nut.play;
  Part fixed, held;
  fixed.name = "bolt";
  fixed.mesh = std::make_shared<const TriangleMesh>(shapes::bolt(bolt));
  held.name = "nut";
  held.mesh = std::make_shared<const TriangleMesh>(shapes::nut(nut));
  held.held = true;
  held.pose.p = t.start;
  t.scene.parts = {fixed, held};
  t.scene.contact.tick_budget = std::numeric_limits<double>::infinity();
  return t;
}

/// Goes at kSpeed to one place after the other: strokes along the axis, and askew with a lean.
class BadHand {
 public:
  BadHand(const Threaded& t, unsigned seed) : t_(t), rng_(seed) {}

  Pose next() {
    if (left_-- <= 0) aim();
    const Vec3 way = to_ - at_;
    const double step = kSpeed * kPeriod;
    at_ += way.norm() > step ? Vec3(way * (step / way.norm())) : way;
    lean_ += 0.05 * (lean_to_ - lean_);
    turns_ += std::clamp(turns_to_ - turns_, -0.002, 0.002);  // 2 turns a second
    const Pose on_thread{rotation(Vec3(0, 0, 2 * kPi * turns_)), t_.start + Vec3(0, 0, t_.pitch * turns_)};
    return {rotation(lean_) * on_thread.q, on_thread.p + at_};
  }

 private:
  double between(double a, double b) { return std::uniform_real_distribution<double>(a, b)(rng_); }
  Vec3 askew(double most) {
    const double x = between(-most, most), y = between(-most, most), z = between(-most, most);
    return {x, y, z};
  }
  void aim() {
    left_ = 5 + static_cast<int>(rng_() % 30);
    const bool hammers = rng_() % 2 == 0;
    to_ = hammers ? Vec3(0, 0, at_.z() > 0 ? -0.005 : 0.005) : askew(0.006);
    lean_to_ = hammers ? Vec3(0, 0, 0) : askew(0.15);
    if (rng_() % 8 == 0) turns_to_ = between(-1.5, 1.5);
  }

  const Threaded& t_;
  std::mt19937 rng_;
  Vec3 at_ = Vec3::Zero(), to_ = Vec3::Zero(), lean_ = Vec3::Zero(), lean_to_ = Vec3::Zero();
  double turns_ = 0, turns_to_ = 0;
  int left_ = 0;
};

void check_hand(int ticks, int sampled) {
  const Threaded t = nut_on_bolt();
  HapticLoop loop(t.scene);
  BadHand hand(t, 17);
  PoseCheck judge;
  double turned = 0, before = 0, worst = 0;
  int pressed = 0;
  for (int k = 0; k < ticks; ++k) {
    const TickReport& r = loop.step(hand.next(), kPeriod);
    for (const Pose& X : r.substeps) {
      // The turn about the axis, whole turns counted.
      const double angle = 2 * std::atan2(X.q.z(), X.q.w());
      turned += std::remainder(angle - before, 2 * kPi);
      before = angle;
      worst = std::max(worst, std::abs(X.p.z() - t.start.z() - t.pitch * turned / (2 * kPi)));
    }
    pressed += r.contacts > 0;
    if (k % (ticks / sampled) == 0)
      for (const Pose& X : r.substeps) judge.add(X);
  }
  CHECK(judge.count_intersecting(t.scene) == 0);
  // A flank farther would be half of a pitch and more; what is over the play is the lean of the nut.
  CHECK(worst < t.play + 0.2 * t.pitch);
  CHECK(worst > 0.5 * t.play);
  CHECK(4 * pressed > 3 * ticks);
  WARN("ticks " << ticks << ", off the helix at most " << 1e3 * worst << " mm, in contact " << pressed);
}

}  // namespace

TEST_CASE("no hand gets a nut through its thread", "[thread_hand]") {
  check_hand(1500, 20);
}
TEST_CASE("no hand gets a nut through its thread, at length", "[.long]") {
  check_hand(1000000, 400);
}
