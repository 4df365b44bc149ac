// A still pen gives a still part.
#include "experiments/hold_case.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/experiment_list.hpp"
#include "experiments/trial.hpp"

namespace tegotae::experiments {
namespace {

constexpr unsigned kFirstSeed = 1000;                                 // as in the test of the same configurations
constexpr double kMoved = 1e-6, kTurned = 1e-4, kForceChange = 0.01;  // m, rad, share
// Less is drawn as this much: the axis is logarithmic.
constexpr double kFloor = 1e-6;

/// The values in ascending order over their rank in percent.
template <typename F>
Series ranked(const std::string& name, const std::vector<Held>& cases, F value) {
  std::vector<double> v;
  for (const Held& h : cases) v.push_back(std::max(value(h), kFloor));
  std::sort(v.begin(), v.end());
  Series s{name, {}, {}};
  for (std::size_t i = 0; i < v.size(); ++i) {
    s.x.push_back(100.0 * static_cast<double>(i + 1) / static_cast<double>(v.size()));
    s.y.push_back(v[i]);
  }
  return s;
}

template <typename F>
double largest(const std::vector<Held>& cases, F value) {
  double most = 0;
  for (const Held& h : cases) most = std::max(most, value(h));
  return most;
}

}  // namespace

Outcome hold(const Work& work) {
  const std::vector<std::string> names = resolvers();
  const int n = work.seeds(100, 10);
  std::vector<std::vector<Held>> all(names.size(), std::vector<Held>(static_cast<std::size_t>(n)));
  work.each("hold", n * static_cast<int>(names.size()), [&](int i) {
    all[static_cast<std::size_t>(i / n)][static_cast<std::size_t>(i % n)] =
        hold_case(names[static_cast<std::size_t>(i / n)], kFirstSeed + static_cast<unsigned>(i % n));
  });
  Outcome out;
  out.title = "Hold: a still pen gives a still part";
  out.intro =
      "Random bodies that a pen has pushed between two to four others and then holds still. After half a second of "
      "settling half a second is watched: by how much does the part move, and the force change? Nothing else moves, so "
      "everything that shows is the method's own. " +
      std::to_string(n) + " configurations, those in which the part touches in the end count.";
  Csv csv{"hold", {"resolver", "seed", "touching", "moved_um", "turned_mrad", "force_change_percent"}};
  Table table{"peak to peak",
              {"resolver", "touching", "still moving", "moved at most (µm)", "turned at most (mrad)",
               "force change at most (%)"}};
  Plot moved{"motion of the center of mass", {"share of the configurations (%)"}, {"peak to peak (µm)", true}, {}};
  Plot force{"change of the force", {"share of the configurations (%)"}, {"peak to peak (%)", true}, {}};
  for (std::size_t r = 0; r < names.size(); ++r) {
    std::vector<Held> touching;
    for (std::size_t i = 0; i < all[r].size(); ++i) {
      const Held& h = all[r][i];
      csv.rows.push_back(
          {names[r], kFirstSeed + i, h.touching ? 1 : 0, 1e6 * h.moved, 1e3 * h.turned, 100 * h.force_change});
      if (h.touching) touching.push_back(h);
    }
    const auto moving = std::count_if(touching.begin(), touching.end(), [](const Held& h) {
      return h.moved > kMoved || h.turned > kTurned || h.force_change > kForceChange;
    });
    const double m = 1e6 * largest(touching, [](const Held& h) { return h.moved; });
    const double t = 1e3 * largest(touching, [](const Held& h) { return h.turned; });
    const double f = 100 * largest(touching, [](const Held& h) { return h.force_change; });
    table.rows.push_back({names[r], touching.size(), moving, m, t, f});
    moved.series.push_back(ranked(names[r], touching, [](const Held& h) { return 1e6 * h.moved; }));
    force.series.push_back(ranked(names[r], touching, [](const Held& h) { return 100 * h.force_change; }));
    if (r > 0) continue;
    out.claims = {at_most(names[r] + ": moved under a still pen", m, 1e6 * kMoved, "µm"),
                  at_most(names[r] + ": turned", t, 1e3 * kTurned, "mrad"),
                  at_most(names[r] + ": change of the force", f, 100 * kForceChange, "%")};
  }
  out.sections = {{"All resolvers",
                   "Configurations in the order of their motion; what is below 1e-6 is drawn there.",
                   {moved, force},
                   {table}}};
  out.csv = {csv};
  return out;
}

}  // namespace tegotae::experiments
