// Penalty methods widen holes (the paper's reference 5): the apparent clearance of a hole by who asks.
#include <cmath>
#include <limits>

#include "experiments/clearance.hpp"
#include "experiments/experiment_list.hpp"
#include "experiments/peg_task.hpp"
#include "peg_in_hole/peg_scene.hpp"

namespace tegotae::experiments {
namespace {

constexpr double kRatio = 0.99, kPegHole = 0.02;  // diametral clearance 0.2 mm
constexpr double kForce = 2;                      // with which the peg is pushed to either side, N
constexpr double kDepthShare = 0.95;              // of the hole: the push goes through the middle of what touches
// Pegs larger than the hole (diameter by the hole's), and what an operator has to press them in.
constexpr double kOversize[] = {1.002, 1.005, 1.01};
constexpr double kPegGiveUp = 3;  // s
// Around peg and hole: for the play so fine that facets are 3 µm high.
constexpr int kSegments = 128, kOversizeSegments = 64;

struct Point {
  double stiffness = 0;  // of a penetrating vertex, N/m; NaN for the default resolver
  double play = 0;       // how far the peg goes from side to side, m
  double deepest = 0;    // of a vertex inside the other part, m
};

/// Pushes the peg in its hole to both sides.
Point measure(const PegTask& peg, double stiffness) {
  const Pose middle{Quat::Identity(), Vec3(0, 0, -kDepthShare * peg.depth()) - peg.tip()};
  Scene scene = peg.scene_at(middle);
  if (std::isfinite(stiffness)) scene.contact.penalty.stiffness = stiffness;
  const Clearance c = measure_clearance(scene, middle, Vec3::UnitX(), kForce);
  return {stiffness, c.play, c.deepest};
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
  const Attempt a = attempt(peg, operator_profile("average"), peg.task(), 1, kPegGiveUp, false);
  return {resolver, ratio, a.completed, -(a.samples.back().X * peg.tip()).z()};
}

/// Pegs larger than their hole, with the resolver `own` and with springs of `stiffness`; how many went in with `own`.
Table too_large_pegs(const Work& work, const std::string& own, double stiffness, int& entered) {
  const bool quick = work.options.quick;
  std::vector<Entry> entries(quick ? 2 : 2 * std::size(kOversize));
  work.each("widening: too large pegs", static_cast<int>(entries.size()), [&](int i) {
    const double ratio = kOversize[quick ? 1 : i / 2];
    entries[static_cast<std::size_t>(i)] = try_in(ratio, i % 2 == 0 ? own : "penalty", stiffness);
  });
  Table pegs{"Pegs larger than their hole, pressed by the operator \"average\" for " +
                 std::to_string(static_cast<int>(kPegGiveUp)) + " s",
             {"peg by hole", "resolver", "at the bottom", "tip below the surface (mm)"}};
  for (const Entry& e : entries) {
    pegs.rows.push_back({apps::ratio_text(e.ratio), e.who, e.in ? "yes" : "no", 1e3 * e.depth});
    entered += e.who == own && e.in ? 1 : 0;
  }
  return pegs;
}

}  // namespace

Outcome widening(const Work& work) {
  const std::string first = resolvers().front();
  const bool quick = work.options.quick;
  const std::vector<double> stiffnesses =
      quick ? std::vector<double>{500, 20000} : std::vector<double>{200, 500, 1000, 2000, 5000, 1e4, 5e4};
  const double clearance = kPegHole * (1 - kRatio), standard = PenaltySettings().stiffness;
  std::vector<Point> points(stiffnesses.size() + 1);
  work.each("widening", static_cast<int>(points.size()), [&](int i) {
    const std::size_t k = static_cast<std::size_t>(i);
    points[k] = k == stiffnesses.size()
                    ? measure(PegTask(kRatio, first, kSegments), std::numeric_limits<double>::quiet_NaN())
                    : measure(PegTask(kRatio, "penalty", kSegments), stiffnesses[k]);
  });
  const Point& own = points.back();
  int entered = 0;
  const Table pegs = too_large_pegs(work, first, standard, entered);

  Outcome out;
  out.title = "Widening: how large a hole appears";
  out.intro =
      "A peg in its hole (20 mm, ratio 0.99: 0.2 mm of play) is pushed to one side and to the other with 2 N. How far "
      "it goes is the clearance that the hand feels. A penalty method answers force with penetration, so holes "
      "grow: what does not fit seems to, which is what the paper's reference 5 warns of. Stiffer springs grow it less, "
      "but "
      "what a 1 kHz loop can render is bounded.";
  Plot plot{"apparent clearance", {"stiffness of a penetrating vertex (N/m)", true}, {"play (µm)"}, {}};
  Series penalty{"penalty", {}, {}}, mine{first, {}, {}}, truth{"true clearance", {}, {}};
  penalty.points = true;
  truth.dash = true;
  Csv csv{"widening", {"resolver", "stiffness_n_per_m", "play_um", "true_um", "deepest_um"}};
  Table table{"", {"resolver", "stiffness (N/m)", "play (µm)", "of the true one (%)", "deepest vertex (µm)"}};
  double widest = 0;
  for (const Point& p : points) {
    const bool is_own = &p == &own;
    const std::string name = is_own ? first : "penalty";
    const nlohmann::json stiffness = is_own ? nlohmann::json("-") : nlohmann::json(p.stiffness);
    csv.rows.push_back({name, stiffness, 1e6 * p.play, 1e6 * clearance, 1e6 * p.deepest});
    table.rows.push_back({name, stiffness, 1e6 * p.play, 100 * p.play / clearance, 1e6 * p.deepest});
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
  out.claims = {at_most(first + ": play by the true clearance", 100 * own.play / clearance, 100, "%"),
                at_least(first + ": play by the true clearance", 100 * own.play / clearance, 85, "%"),
                at_most(first + ": pegs larger than the hole that go in", entered, 0, ""),
                at_least("penalty widens: play by the true clearance", 100 * widest / clearance, 110, "%")};
  out.sections = {{"Play from side to side", "", {plot}, {table}}, {"What does not fit", "", {}, {pegs}}};
  out.csv = {csv};
  return out;
}

}  // namespace tegotae::experiments
