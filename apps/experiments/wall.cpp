// The paper's figures 7 and 8: a cube is pushed against a wall, then against a floor.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "device/script_hand.hpp"
#include "experiments/experiment_list.hpp"
#include "experiments/smooth_script.hpp"
#include "experiments/statistics.hpp"
#include "experiments/trial.hpp"
#include "models/shapes.hpp"

namespace tegotae::experiments {
namespace {

constexpr double kEdge = 0.04;            // of the cube, m
constexpr double kWallX = 0.01;           // of the cube's center when it lies on the wall, m
constexpr double kFloorZ = -0.01;         // of the cube's center when it lies on the floor, m
constexpr double kPushed = 0.012;         // how far the hand goes on behind the wall and the floor, m
constexpr double kTilt = 12 * 0.0174533;  // of the cube in procedure B, about y, rad
// The phases of the figures: (A) free, (B) at the wall, (C) at wall and floor; s.
constexpr double kBegin = 0.5, kAtWall = 1.5, kDown = 3.0, kHold = 4.5, kEnd = 5.5;
// Force that indicates contact (N). Sliding down the wall, the cube rubs: contact with the floor is detected by the
// pen.
constexpr double kTouch = 0.02;
// After the first touch the cube settles on its gap, s.
constexpr double kSettle = 0.1;

Scene cube_scene(double tilt, const std::string& resolver) {
  const auto part = [](const char* name, TriangleMesh mesh, const Pose& X, bool held) {
    return Part{name, std::make_shared<const TriangleMesh>(std::move(mesh)), X, held};
  };
  Scene scene;
  scene.contact.resolver = resolver_kind(resolver);
  constexpr double kThick = 0.02, kWide = 0.16;
  const double wall_x = kWallX + kEdge / 2 + kThick / 2, floor_z = kFloorZ - kEdge / 2 - kThick / 2;
  scene.parts.push_back(part("wall", shapes::box({kThick, kWide, kWide}, {1, 8, 8}),
                             {Quat::Identity(), {wall_x, 0, kWide / 2 + floor_z + kThick / 2}}, false));
  scene.parts.push_back(
      part("floor", shapes::box({kWide, kWide, kThick}, {8, 8, 1}), {Quat::Identity(), {-0.05, 0, floor_z}}, false));
  scene.parts.push_back(
      part("cube", shapes::box({kEdge, kEdge, kEdge}, {2, 2, 2}), {rotation({0, tilt, 0}), {-0.02, 0, 0.02}}, true));
  return scene;
}

/// Procedure A (upright, `tilt` 0) or B (held at a tilt all the time).
StylusScript push(double tilt) {
  const auto at = [&](double t, double x, double z) {
    return StylusScript::Key{t, {rotation({0, tilt, 0}), {x, 0, z}}};
  };
  return smooth_script({at(0, -0.02, 0.02), at(kBegin, -0.02, 0.02), at(kAtWall + 0.7, kWallX + kPushed, 0.02),
                        at(kDown, kWallX + kPushed, 0.02), at(kHold, kWallX + kPushed, kFloorZ - kPushed),
                        at(kEnd, kWallX + kPushed, kFloorZ - kPushed)});
}

struct Trace {
  std::vector<Sample> samples;
  CouplingSettings coupling;
  std::optional<double> wall, floor;  ///< times of the first force in x and z, s
};

Trace run_push(double tilt, const std::string& resolver) {
  const Scene scene = cube_scene(tilt, resolver);
  ScriptHand hand(push(tilt));
  Trace trace{run_trial(scene, {}, hand, nullptr, kEnd, nullptr), scene.coupling, {}, {}};
  for (const Sample& s : trace.samples) {
    if (!trace.wall && s.wrench.force.x() < -kTouch) trace.wall = s.t;
    if (!trace.floor && s.Y.p.z() < kFloorZ && s.wrench.force.z() > kTouch) trace.floor = s.t;
  }
  return trace;
}

/// How far coordinate `k` of the cube's center moves from `from` on, m.
double range(const Trace& trace, int k, double from) {
  double low = INFINITY, high = -INFINITY;
  for (const Sample& s : trace.samples) {
    if (s.t < from) continue;
    low = std::min(low, s.center[k]);
    high = std::max(high, s.center[k]);
  }
  return high - low;
}

struct Figures {
  double blocked_x, blocked_z;  // m
  double early;                 // largest force while the pen is still before the wall, N
  double onset;                 // how far the pen was past the wall's contact when the force began, m
  double slope;                 // of F over X - Y against the coupling's, relative error
  double rest;                  // worst |F - k (X - Y)| / |F| while the pen rests at the end
  double pen_went_on;           // behind the wall, m
};

Figures measure_a(const Trace& trace) {
  Figures f{};
  if (!trace.wall || !trace.floor) return {INFINITY, INFINITY, INFINITY, INFINITY, INFINITY, INFINITY, 0};
  f.blocked_x = range(trace, 0, *trace.wall + kSettle);
  f.blocked_z = range(trace, 2, *trace.floor + kSettle);
  std::vector<double> stretch, force;
  for (const Sample& s : trace.samples) {
    const double past = s.Y.p.x() - kWallX;
    if (past < -1e-4) f.early = std::max(f.early, s.wrench.force.norm());
    if (s.t == *trace.wall) f.onset = std::abs(past);
    f.pen_went_on = std::max(f.pen_went_on, past);
    if (s.t > *trace.wall + kSettle && s.t < kDown) {
      stretch.push_back(s.X.p.x() - s.Y.p.x());
      // Nothing but the pen moves along x: what its speed adds is the damper's.
      force.push_back(s.wrench.force.x() + trace.coupling.damping * s.pen.v.x());
    }
    if (s.t > kEnd - 0.3) {
      const Vec3 expected = trace.coupling.stiffness * (s.X.p - s.Y.p);
      f.rest = std::max(f.rest, (s.wrench.force - expected).norm() / expected.norm());
    }
  }
  f.slope = std::abs(slope(stretch, force) / trace.coupling.stiffness - 1);
  return f;
}

double tilt_of(const Pose& X) {
  return rotation_vector(X.q).y();
}

struct TiltFigures {
  double left;    // tilt of the cube while it is pushed on the wall, rad
  double sign;    // share of the ticks in contact whose torque turns the pen back
  double torque;  // worst relative error of the torque against k_t (tilt of X - tilt of Y) at the end
  double pen;     // tilt that the pen keeps, rad
};

TiltFigures measure_b(const Trace& trace) {
  TiltFigures f{0, 0, 0, 0};
  int touching = 0, right = 0;
  for (const Sample& s : trace.samples) {
    const double torque = s.wrench.torque.y();
    if (std::abs(torque) > 1e-3) {
      ++touching;
      right += torque * tilt_of(s.Y) < 0 ? 1 : 0;
    }
    if (s.t > kEnd - 0.3) {
      f.left = std::max(f.left, std::abs(tilt_of(s.X)));
      f.pen = tilt_of(s.Y);
      const double expected = trace.coupling.torsional_stiffness * (tilt_of(s.X) - tilt_of(s.Y));
      f.torque = std::max(f.torque, std::abs(torque / expected - 1));
    }
  }
  f.sign = touching > 0 ? static_cast<double>(right) / touching : 0;
  return f;
}

template <typename F>
Series series(const std::string& name, const Trace& trace, F value, bool dash = false) {
  Series s{name, {}, {}};
  for (const Sample& sample : trace.samples) {
    s.x.push_back(sample.t);
    s.y.push_back(value(sample));
  }
  thin(s, 1400);
  s.dash = dash;
  return s;
}

std::vector<Mark> phases(const Trace& trace) {
  std::vector<Mark> marks{{0, "(A)"}};
  if (trace.wall) marks.push_back({*trace.wall, "(B)"});
  if (trace.floor) marks.push_back({*trace.floor, "(C)"});
  return marks;
}

Csv csv_of(const std::string& name, const Trace& trace) {
  Csv csv{name,
          {"t_s", "x_mm", "z_mm", "pen_x_mm", "pen_z_mm", "tilt_mrad", "pen_tilt_mrad", "fx_n", "fz_n", "ty_mnm"}};
  for (const Sample& s : trace.samples)
    csv.rows.push_back({s.t, 1e3 * s.center.x(), 1e3 * s.center.z(), 1e3 * s.Y.p.x(), 1e3 * s.Y.p.z(),
                        1e3 * tilt_of(s.X), 1e3 * tilt_of(s.Y), s.wrench.force.x(), s.wrench.force.z(),
                        1e3 * s.wrench.torque.y()});
  return csv;
}

Section section_a(const Trace& t) {
  Section s{
      "Procedure A: upright (the paper's figure 7)",
      "(A) The cube follows the pen. (B) It meets the wall: its x stays, the pen's goes on, and the force grows with "
      "their distance. (C) It slides down the wall to the floor, and z stays too.",
      {}};
  s.plots.push_back({"position",
                     {"time (s)"},
                     {"position (mm)"},
                     {series("x, cube", t, [](const Sample& a) { return 1e3 * a.center.x(); }),
                      series(
                          "x, pen", t, [](const Sample& a) { return 1e3 * a.Y.p.x(); }, true),
                      series("z, cube", t, [](const Sample& a) { return 1e3 * a.center.z(); }),
                      series(
                          "z, pen", t, [](const Sample& a) { return 1e3 * a.Y.p.z(); }, true)},
                     false,
                     phases(t)});
  s.plots.push_back({"force on the pen",
                     {"time (s)"},
                     {"force (N)"},
                     {series("x", t, [](const Sample& a) { return a.wrench.force.x(); }),
                      series("z", t, [](const Sample& a) { return a.wrench.force.z(); })},
                     false,
                     phases(t)});
  return s;
}

Section section_b(const Trace& t) {
  Section s{
      "Procedure B: tilted (figure 8)",
      "The pen holds the cube at 12° all the time. (A) The cube is tilted like the pen. (B) Its edge meets the wall "
      "and it is laid flat: its tilt goes to zero, and the torque pulls the pen the same way. (C) It goes down to the "
      "floor, flat on both.",
      {}};
  s.plots.push_back({"tilt",
                     {"time (s)"},
                     {"tilt about y (mrad)"},
                     {series("cube", t, [](const Sample& a) { return 1e3 * tilt_of(a.X); }),
                      series(
                          "pen", t, [](const Sample& a) { return 1e3 * tilt_of(a.Y); }, true)},
                     false,
                     phases(t)});
  s.plots.push_back({"torque on the pen",
                     {"time (s)"},
                     {"torque about y (mN·m)"},
                     {series("torque", t, [](const Sample& a) { return 1e3 * a.wrench.torque.y(); })},
                     false,
                     phases(t)});
  return s;
}

}  // namespace

Outcome wall(const Work& work) {
  const std::vector<std::string> names = resolvers();
  std::vector<Trace> a(names.size()), b(names.size());
  work.each("wall", static_cast<int>(2 * names.size()), [&](int i) {
    const std::size_t r = static_cast<std::size_t>(i / 2);
    (i % 2 == 0 ? a : b)[r] = run_push(i % 2 == 0 ? 0 : kTilt, names[r]);
  });
  Outcome out;
  out.title = "Wall: a cube against a wall and a floor";
  out.intro =
      "A hand carries a cube of 40 mm against a wall and then down to a floor, and goes on 12 mm behind either. The "
      "paper "
      "shows that the blocked coordinate stays while the pen goes on, that the force follows k (X − Y) from the moment "
      "of "
      "contact, and that a tilted cube is turned flat by the torque.";
  Table table{"all resolvers",
              {"resolver", "x blocked within (µm)", "z blocked within (µm)", "error of the slope of F (%)",
               "|F − k (X − Y)| at rest (%)", "tilt left (mrad)", "torque error (%)"}};
  for (std::size_t r = 0; r < names.size(); ++r) {
    const Figures f = measure_a(a[r]);
    const TiltFigures t = measure_b(b[r]);
    table.rows.push_back(
        {names[r], 1e6 * f.blocked_x, 1e6 * f.blocked_z, 100 * f.slope, 100 * f.rest, 1e3 * t.left, 100 * t.torque});
    if (r > 0) continue;
    out.claims = {at_most("x stays while the pen goes on behind the wall", 1e6 * f.blocked_x, 1, "µm"),
                  at_most("z stays while the pen goes on into the floor", 1e6 * f.blocked_z, 1, "µm"),
                  at_least("the pen goes on behind the wall", 1e3 * f.pen_went_on, 3, "mm"),
                  at_most("force before contact", f.early, 0, "N"),
                  at_most("pen past the contact when the force begins", 1e3 * f.onset, 0.15, "mm"),
                  at_most("slope of F (the damper's part taken off) over X − Y against k", 100 * f.slope, 1, "%"),
                  at_most("F against k (X − Y) at rest", 100 * f.rest, 1, "%"),
                  at_most("tilt of the cube laid flat", 1e3 * t.left, 1, "mrad"),
                  at_least("tilt that the pen keeps", 1e3 * std::abs(t.pen), 50, "mrad"),
                  at_least("share of ticks whose torque turns the pen flat", 100 * t.sign, 99, "%"),
                  at_most("torque against k_t times the difference of tilts at rest", 100 * t.torque, 1, "%")};
  }
  out.sections = {section_a(a[0]),
                  section_b(b[0]),
                  {"All resolvers", "The plots are those of the default, " + names[0] + ".", {}, {table}}};
  for (std::size_t r = 0; r < names.size(); ++r) {
    out.csv.push_back(csv_of("procedure_a_" + names[r], a[r]));
    out.csv.push_back(csv_of("procedure_b_" + names[r], b[r]));
  }
  return out;
}

}  // namespace tegotae::experiments
