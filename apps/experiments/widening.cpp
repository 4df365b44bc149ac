// Penalty methods widen holes (the paper's reference 5): the apparent clearance of a hole by who asks.
#include <cmath>
#include <cstdio>
#include <limits>

#include "experiments/experiment_list.hpp"
#include "experiments/peg_task.hpp"
#include "peg_scene.hpp"
#include "tegotae/sim/haptic_loop.hpp"

namespace tegotae::experiments {
namespace {

constexpr double kRatio = 0.99, kHole = 0.02;  // diametral clearance 0.2 mm
constexpr double kPush = 3e-3;                 // how far the pen goes to either side, m
constexpr double kDepthShare = 0.95;           // of the hole: the push goes through the middle of what touches
constexpr int kRampTicks = 400, kRestTicks = 400;
// Pegs larger than the hole (diameter by the hole's), and what an operator has to press them in.
constexpr double kOversize[] = {1.002, 1.005, 1.01};
constexpr double kGiveUp = 3;  // s
// Around peg and hole: for the play so fine that facets are 3 µm high.
constexpr int kSegments = 128, kOversizeSegments = 64;

struct Point {
  double stiffness = 0;  // of a penetrating vertex, N/m; NaN for the default resolver
  double play = 0;       // how far the peg goes from side to side, m
  double force = 0;      // with which it is pushed, N
};

/// Pushes the peg in its hole to both sides.
Point measure(const PegTask& peg, double stiffness) {
  const Pose middle{Quat::Identity(), Vec3(0, 0, -kDepthShare * peg.depth()) - peg.tip()};
  Scene scene = peg.scene_at(middle);
  scene.contact.tick_budget = std::numeric_limits<double>::infinity();
  if (std::isfinite(stiffness)) scene.contact.penalty.stiffness = stiffness;
  HapticLoop loop(scene);
  Point out;
  out.stiffness = stiffness;
  double side[2], from = 0;
  for (int i = 0; i < 2; ++i) {
    const double to = i == 0 ? -kPush : kPush;
    Pose Y = middle;
    for (int tick = 1; tick <= kRampTicks + kRestTicks; ++tick) {
      const double s = std::min(1.0, static_cast<double>(tick) / kRampTicks);
      Y.p.x() = from + s * (to - from);
      loop.step(Y, 1e-3);
    }
    const ProxyState& x = loop.report().proxy;
    side[i] = (x.X * loop.center()).x();
    out.force = coupling_wrench(scene.coupling, x, Y, {}, loop.center()).force.norm();
    from = to;
  }
  out.play = side[1] - side[0];
  return out;
}

struct Entry {
  std::string who;
  double ratio = 0;
  bool in = false;
  double depth = 0;  // of the tip, m
};

Entry try_in(double ratio, const std::string& resolver, double stiffness) {
  PegTask peg(ratio, resolver, kOversizeSegments);
  peg.set_penalty_stiffness(stiffness);
  const Attempt a = attempt(peg, operator_profile("average"), peg.task(), 1, kGiveUp, false);
  return {resolver, ratio, a.completed, -(a.samples.back().X * peg.tip()).z()};
}


}  // namespace

Outcome widening(const Work& work) {
  const std::string first = resolvers().front();
  const bool quick = work.options.quick;
  const std::vector<double> stiffnesses = quick ? std::vector<double>{500, 20000}
                                                : std::vector<double>{200, 500, 1000, 2000, 5000, 1e4, 5e4};
  const double clearance = kHole * (1 - kRatio), standard = PenaltySettings().stiffness;
  std::vector<Point> points(stiffnesses.size() + 1);
  work.each("widening", static_cast<int>(points.size()), [&](int i) {
    const std::size_t k = static_cast<std::size_t>(i);
    points[k] = k == stiffnesses.size() ? measure(PegTask(kRatio, first, kSegments), std::numeric_limits<double>::quiet_NaN())
                                        : measure(PegTask(kRatio, "penalty", kSegments), stiffnesses[k]);
  });
  const Point& own = points.back();
  std::vector<Entry> entries(quick ? 2 : 2 * std::size(kOversize));
  work.each("widening: too large pegs", static_cast<int>(entries.size()), [&](int i) {
    const double ratio = kOversize[quick ? 1 : i / 2];
    entries[static_cast<std::size_t>(i)] = try_in(ratio, i % 2 == 0 ? first : "penalty", standard);
  });

  Outcome out;
  out.title = "Widening: how large a hole appears";
  char text[64];
  std::snprintf(text, sizeof text, "%.1f N", own.force);
  out.intro =
      std::string("A peg in its hole (20 mm, ratio 0.99: 0.2 mm of play) is pushed to one side and to the other with ") +
      text +
      ". How far it goes is the clearance that the hand feels. A penalty method answers force with penetration, so holes "
      "grow: what does not fit seems to, which is what the paper's reference 5 warns of. Stiffer springs grow it less, but "
      "what a 1 kHz loop can render is bounded.";
  Plot plot{"apparent clearance", {"stiffness of a penetrating vertex (N/m)", true}, {"play (µm)", true}, {}};
  Series penalty{"penalty", {}, {}}, mine{first, {}, {}}, truth{"true clearance", {}, {}};
  penalty.points = true;
  truth.dash = true;
  Csv csv{"widening", {"resolver", "stiffness_n_per_m", "play_um", "true_um", "force_n"}};
  Table table{"", {"resolver", "stiffness (N/m)", "play (µm)", "of the true one (%)", "force (N)"}};
  double widest = 0;
  for (const Point& p : points) {
    const bool is_own = &p == &own;
    const std::string name = is_own ? first : "penalty";
    const nlohmann::json stiffness = is_own ? nlohmann::json("-") : nlohmann::json(p.stiffness);
    csv.rows.push_back({name, stiffness, 1e6 * p.play, 1e6 * clearance, p.force});
    table.rows.push_back({name, stiffness, 1e6 * p.play, 100 * p.play / clearance, p.force});
    if (is_own) continue;
    penalty.x.push_back(p.stiffness);
    penalty.y.push_back(1e6 * p.play);
    mine.x.push_back(p.stiffness);
    mine.y.push_back(1e6 * own.play);
    truth.x.push_back(p.stiffness);
    truth.y.push_back(1e6 * clearance);
    if (p.stiffness <= standard) widest = std::max(widest, p.play);
  }
  plot.series = {penalty, mine, truth};
  Table pegs{"Pegs larger than their hole, pressed by the operator \"average\" for " + std::to_string(static_cast<int>(kGiveUp)) + " s",
             {"peg by hole", "resolver", "at the bottom", "tip below the surface (mm)"}};
  int entered = 0;
  for (const Entry& e : entries) {
    pegs.rows.push_back({apps::ratio_text(e.ratio), e.who, e.in ? "yes" : "no", 1e3 * e.depth});
    entered += e.who == first && e.in ? 1 : 0;
  }
  out.claims = {at_most(first + ": play by the true clearance", 100 * own.play / clearance, 100, "%"),
                at_least(first + ": play by the true clearance", 100 * own.play / clearance, 85, "%"),
                at_most(first + ": pegs larger than the hole that go in", entered, 0, ""),
                at_least("penalty widens: play by the true clearance", 100 * widest / clearance, 110, "%")};
  out.sections = {{"Play from side to side", "", {plot}, {table}}, {"What does not fit", "", {}, {pegs}}};
  out.csv = {csv};
  return out;
}

}  // namespace tegotae::experiments
