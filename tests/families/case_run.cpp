#include "families/case_run.hpp"

#include <time.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>

#include "families/judges.hpp"
#include "session/step_schedule.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/loop/haptic_loop.hpp"

namespace tegotae::test {
namespace {

constexpr double kPeriod = 1e-3;  // s
// A part has this long to arrive where it rests, ticks.
constexpr int kRestTicks = 100, kRestTicksRealTime = 300;
// Poses asked of FCL in a case; where large surfaces mate it takes a second for one.
constexpr int kAsked = 16, kAskedLarge = 6;
constexpr int kLarge = 50000;  // triangles
// Nearer than this (m) a part at the end is taken to touch.
constexpr double kApart = 1e-7;

double cpu_seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// The corners of a mesh's bounding box and their middle.
struct Box {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  explicit Box(const TriangleMesh& mesh) {
    for (const Vec3& v : mesh.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
  }
  Vec3 middle() const { return (low + high) / 2; }
  double most_apart(const Pose& A, const Pose& B) const {
    double most = 0;
    for (int i = 0; i < 8; ++i) {
      const Vec3 corner((i & 1 ? high : low).x(), (i & 2 ? high : low).y(), (i & 4 ? high : low).z());
      most = std::max(most, (A * corner - B * corner).norm());
    }
    return most;
  }
};

/// Committed poses that intersect, asked of FCL about an even sample.
class Sample {
 public:
  Sample(const TouchLine& line, int ticks, int asked) : line_(line), stride_(std::max(1, ticks / asked)) {}
  void look(int tick, const Pose& X) {
    if (tick % stride_ != 0) return;
    ++asked_;
    if (line_.intersects(X) && ++intersecting_ == 1) first_ = tick;
  }
  void judge(std::vector<Finding>& out) const {
    if (intersecting_ == 0) return;
    out.push_back({"committed poses that intersect, the first one in tick " + std::to_string(first_),
                   std::to_string(intersecting_) + " of " + std::to_string(asked_), "0"});
  }

 private:
  const TouchLine& line_;
  int stride_, asked_ = 0, intersecting_ = 0, first_ = 0;
};

/// A line a tick, lengths in mm.
class Trace {
 public:
  explicit Trace(const std::string& path) {
    if (path.empty()) return;
    out_.open(path);
    if (!out_) throw Error(path + ": cannot be written");
    out_ << "tick,phase,pen,part,off,force_N,contacts,gap,cut,fraction,x,y,z,rx,ry,rz\n";
  }
  void look(int tick, const CaseTick& t, const TickReport& r) {
    if (!out_.is_open()) return;
    const Vec3 p = 1e3 * r.proxy.X.p, turned = rotation_vector(r.proxy.X.q);
    out_ << tick << ',' << static_cast<int>(t.phase) << ',' << 1e3 * t.pen << ',' << 1e3 * t.part << ',' << 1e3 * t.off
         << ',' << t.force << ',' << t.contacts << ',' << 1e3 * r.gap << ',' << r.flags.timed_out << ',' << r.fraction;
    for (const double x : {p.x(), p.y(), p.z(), turned.x(), turned.y(), turned.z()}) out_ << ',' << x;
    out_ << '\n';
  }

 private:
  std::ofstream out_;
};

void run_loop(const FamilyCase& c, const CaseOptions& options, CaseResult& result) {
  HapticLoop loop(c.scene);
  const CasePen pen(c, options.real_time ? kRestTicksRealTime : kRestTicks);
  const Box box(*c.scene.parts.back().mesh);
  const double before = cpu_seconds();
  const TouchLine line(c.scene);
  Judges judges(c, options, find_truth(c, line));
  Sample sample(line, pen.ticks(), result.triangles > kLarge ? kAskedLarge : kAsked);
  result.seconds_judges += cpu_seconds() - before;
  Trace trace(options.trace);
  const Vec3 middle = box.middle(), seat = c.seat * middle;
  StepSchedule schedule(std::llround(1e9 * kPeriod));
  schedule.begin(monotonic_ns());
  for (int tick = 0; tick < pen.ticks(); ++tick) {
    // The threads that help go on in between, as they do beside a pen.
    const std::int64_t begun = options.real_time ? schedule.wait() : 0;
    const Pose Y = pen.pose(tick);
    const double start = cpu_seconds();
    const TickReport& r = loop.step(Y, kPeriod);
    const double done = cpu_seconds();
    if (options.real_time) schedule.done(begun, monotonic_ns());
    const Pose& X = r.proxy.X;
    const double force = c.scene.coupling.stiffness * (X * middle - Y * middle).norm();
    const CaseTick look = {pen.phase(tick),
                           pen.last(tick),
                           (Y * middle - seat).dot(c.approach),
                           (X * middle - seat).dot(c.approach),
                           box.most_apart(X, Y),
                           r.proxy.touching ? force : 0,
                           r.contacts,
                           r.gap};
    judges.look(look);
    trace.look(tick, look, r);
    sample.look(tick, X);
    result.cut += r.flags.timed_out;
    result.seconds_loop += done - start;
    result.seconds_judges += cpu_seconds() - done;
  }
  const double way = judges.came_off() ? 0 : line.travel(loop.report().proxy.X, -c.approach, c.start, kApart);
  result.findings = judges.findings(way);
  result.waited = judges.waited();
  result.lifted = judges.lifted();
  sample.judge(result.findings);
}

}  // namespace

CaseResult run_case(const FamilyParameters& parameters, const CaseOptions& options) {
  FamilyCase c = make_family(parameters);
  if (!options.real_time) c.scene.contact.tick_budget = std::numeric_limits<double>::infinity();
  CaseResult result;
  result.parameters = c.parameters;
  for (const Part& part : c.scene.parts) result.triangles += static_cast<int>(part.mesh->triangles.size());
  try {
    run_loop(c, options, result);
  } catch (const Error& e) {
    result.findings.push_back({"the start", e.what(), "free"});
  }
  return result;
}

std::string describe(const FamilyParameters& p, const CaseOptions& options) {
  char text[256];
  std::snprintf(text, sizeof text, "%s seed %u, %d triangles, clearance %g mm, size %g mm, %d near, %s",
                p.family.c_str(), p.seed, p.triangles, 1e3 * p.clearance, 1e3 * p.size, p.near,
                options.real_time ? "real time" : "virtual time");
  return text;
}

std::string arguments(const FamilyParameters& p, const CaseOptions& options) {
  char text[256];
  std::snprintf(text, sizeof text, "--family %s --seed %u --triangles %d --clearance %.9g --size %.9g --near %d%s",
                p.family.c_str(), p.seed, p.triangles, p.clearance, p.size, p.near,
                options.real_time ? " --real-time" : "");
  return text;
}

}  // namespace tegotae::test
