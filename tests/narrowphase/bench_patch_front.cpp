// Figures of the patch hierarchy and its path certificate: build, cold front, warm ticks. Not a test.
// Usage: bench_patch_front [ticks]
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "narrowphase/patch_front.hpp"
#include "patch_shapes.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

/// Processor time of this thread: other programs on the machine do not count, as far as they leave the caches alone.
std::int64_t thread_ns() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}
double micros(std::int64_t from) {
  return static_cast<double>(thread_ns() - from) * 1e-3;
}

std::shared_ptr<PatchTree> build(const char* name, const MeshPtr& mesh) {
  const auto t = thread_ns();
  auto tree = std::make_shared<PatchTree>(mesh);
  const double us = micros(t), n = static_cast<double>(mesh->triangles.size());
  std::printf("  %-6s %8.0f triangles, built in %.3f s = %.2f us and %.0f bytes a triangle\n", name, n, us * 1e-6,
              us / n, static_cast<double>(tree->bytes()) / n);
  return tree;
}

struct Figures {
  std::vector<double> us;
  double cold_us = 0;
  int cold_pairs = 0, failed = 0;
  long pairs = 0, searches = 0, splits = 0, merges = 0;

  void print() {
    std::sort(us.begin(), us.end());
    const double n = static_cast<double>(us.size());
    auto at = [&](double q) { return us[static_cast<std::size_t>(q * (n - 1))]; };
    std::printf(
        "  cold %d pairs %.0f us; warm p50 %.1f p99 %.1f p99.9 %.1f max %.1f us; pairs %.0f searches %.1f splits "
        "%.2f merges %.2f; not certified %d of %.0f\n",
        cold_pairs, cold_us, at(0.5), at(0.99), at(0.999), us.back(), static_cast<double>(pairs) / n,
        static_cast<double>(searches) / n, static_cast<double>(splits) / n, static_cast<double>(merges) / n, failed, n);
  }
};

void add(Figures& f, const CertifyReport& r, double us) {
  f.us.push_back(us);
  f.failed += r.status != CertifyStatus::certified;
  f.pairs += r.pairs, f.searches += r.searches, f.splits += r.splits, f.merges += r.merges;
}

/// Wanted motions that are not free: sideways into the wall, down to a tenth of a peg's clearance and up to
/// millimeters.
void pushed(PatchFront& front, const Pose& X, int ticks) {
  std::mt19937 rng(3);
  Figures f;
  double blocking = 0;
  for (int i = 0; i < ticks; ++i) {
    const double size = std::pow(10.0, uniform(rng, -4.5, -3));
    const Displacement d{random_in_ball(rng, size), random_in_ball(rng, 10 * size)};
    const auto t0 = thread_ns();
    const CertifyReport report = front.certify(X, d);
    add(f, report, micros(t0));
    blocking += static_cast<double>(front.blocking().size());
    // A still tick, as the loop would have it after a shortened step.
    front.certify(X, {});
  }
  std::printf("  pushed to poses that are not free (mean %.1f blocking pairs):\n", blocking / ticks);
  f.print();
}

/// A peg that slides along both ends of its clearance, in and out, turning; `speed` 1 is 0.1 mm and 0.5 mrad a tick.
void peg_in_hole(int peg_triangles, int hole_triangles, double ratio, double gap, double speed, int ticks) {
  std::printf("peg %d / hole %d @%g, gap %g um, speed %g\n", peg_triangles, hole_triangles, ratio, gap * 1e6, speed);
  const double R = 0.01, r = ratio * R, length = 0.04, clearance = R - r - gap;
  const auto a = build("peg", peg(r, length, peg_triangles));
  const auto b = build("hole", hole(R, length, hole_triangles));
  const Vec3 center(0, 0, length / 2);
  auto pose = [&](int tick) {
    const double t = tick * speed;
    // The axis at the lower end and at the mouth moves on circles inside the clearance; axial travel is a triangle wave
    // between 20 % and 98 % depth.
    const Vec3 low(clearance * std::cos(0.011 * t), clearance * std::sin(0.011 * t), 0);
    const Vec3 high(clearance * std::cos(0.017 * t + 2), clearance * std::sin(0.017 * t + 2), 0);
    const double span = 0.78 * length, u = std::fmod(t * 1e-4, 2 * span);
    const double depth = 0.98 * length - (u < span ? u : 2 * span - u);
    const Vec3 axis = (high - low + Vec3(0, 0, depth)).normalized();
    Pose X;
    X.q = Quat::FromTwoVectors(Vec3::UnitZ(), axis) * rotation(Vec3(0, 0, 5e-4 * t));
    X.p = low - Vec3(0, 0, depth);
    return X;
  };
  PatchFront front;
  front.attach(*a, center, *b);
  Figures f;
  Pose X = pose(0);
  auto t0 = thread_ns();
  const CertifyReport cold = front.certify(X, {});
  f.cold_us = micros(t0);
  f.cold_pairs = cold.pairs;
  if (cold.status != CertifyStatus::certified) {
    std::printf("  cold: not certified (%d), blocking %zu, searches %d\n", static_cast<int>(cold.status),
                front.blocking().size(), cold.searches);
  }
  for (int i = 1; i <= ticks; ++i) {
    const Pose Y = pose(i);
    const Displacement d = displacement(X, Y, center);
    t0 = thread_ns();
    const CertifyReport report = front.certify(X, d);
    add(f, report, micros(t0));
    X = Y;
  }
  f.print();
  pushed(front, X, ticks);
}

/// Two knots; A drifts and turns, and turns back where it is blocked.
void knots(int triangles, int ticks) {
  std::printf("knots %d / %d\n", triangles, triangles);
  const auto a = build("A", knot(0.05, 0.006, triangles));
  const auto b = build("B", knot(0.05, 0.006, triangles));
  std::mt19937 rng(7);
  PatchFront front;
  front.attach(*a, Vec3::Zero(), *b);
  Figures f;
  Pose X{rotation(Vec3(0.3, 0.2, 0.1)), Vec3(0.12, 0, 0)};
  auto t0 = thread_ns();
  f.cold_pairs = front.certify(X, {}).pairs;
  f.cold_us = micros(t0);
  Displacement d;
  int blocked = 0;
  for (int i = 0; i < ticks; ++i) {
    if (i % 20 == 0 || blocked > 0) {
      d.dp = random_in_ball(rng, 1e-4) - 3e-5 * X.p.normalized();
      d.dr = random_in_ball(rng, 2e-3);
    }
    t0 = thread_ns();
    const CertifyReport report = front.certify(X, d);
    add(f, report, micros(t0));
    blocked = report.status != CertifyStatus::certified;
    if (!blocked) X = displaced(X, Vec3::Zero(), d);
  }
  f.print();
}

}  // namespace

int main(int argc, char** argv) {
  const int ticks = argc > 1 ? std::atoi(argv[1]) : 2000;
  for (double speed : {1.0, 4.0}) {
    peg_in_hole(2000, 2000, 0.99, 1e-5, speed, ticks);
    peg_in_hole(20000, 20000, 0.99, 1e-5, speed, ticks);
    peg_in_hole(20000, 20000, 0.999, 4e-6, speed, ticks);
    if (argc > 2) continue;
    peg_in_hole(200000, 200000, 0.99, 1e-5, speed, ticks);
    peg_in_hole(20000, 1000000, 0.99, 1e-5, speed, ticks);
  }
  knots(20000, ticks);
  if (argc <= 2) knots(100000, ticks);
}
