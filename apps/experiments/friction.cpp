// Friction against closed forms, on meshes and in the contact loop.
#include <algorithm>
#include <cmath>

#include "experiments/experiment_list.hpp"
#include "experiments/friction_motion.hpp"
#include "experiments/friction_peg.hpp"
#include "experiments/friction_scenes.hpp"
#include "experiments/friction_tips.hpp"
#include "experiments/load_rig.hpp"

namespace tegotae::experiments {
namespace {

constexpr double kNano = 1e9, kMicro = 1e6;

template <typename T, typename F>
double largest(const std::vector<T>& all, F value) {
  double most = 0;
  for (const T& one : all) most = std::isnan(value(one)) ? value(one) : std::max(most, value(one));
  return most;
}

void add_thresholds(const Work& work, Outcome& out) {
  std::vector<Threshold> all = thresholds(work.options.quick);
  for (Threshold& t : tip_thresholds(work.options.quick)) all.push_back(std::move(t));
  const int steps = work.options.quick ? 1000 : 4000;
  std::vector<double> found(all.size());
  work.each("thresholds", static_cast<int>(all.size()), [&](int i) {
    const Threshold& t = all[static_cast<std::size_t>(i)];
    found[static_cast<std::size_t>(i)] = LoadRig(t.scene).onset(t.from, t.to, steps, t.load);
  });
  Csv csv{"thresholds", {"case", "formula", "expected", "measured", "error_percent"}, {}};
  Table table{"", {"case", "formula", "expected", "measured", "error (%)"}};
  double worst = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double error = 100 * (found[i] / all[i].expected - 1);
    worst = std::isnan(error) ? error : std::max(worst, std::abs(error));
    table.rows.push_back({all[i].name, all[i].formula, all[i].expected, found[i], error});
    csv.rows.push_back({all[i].name, all[i].formula, all[i].expected, found[i], error});
  }
  std::vector<double> locks(screws().size());
  work.each("self-locking", static_cast<int>(locks.size()), [&](int i) {
    locks[static_cast<std::size_t>(i)] = self_locking_mu(screws()[static_cast<std::size_t>(i)]);
  });
  for (std::size_t i = 0; i < locks.size(); ++i) {
    const Screw& s = screws()[i];
    const double expected = s.lead() * s.flank(), error = 100 * (locks[i] / expected - 1);
    worst = std::isnan(error) ? error : std::max(worst, std::abs(error));
    const std::string name = std::string(s.name) + ", holds itself from", formula = "mu = tan(lead) cos(flank)";
    table.rows.push_back({name, formula, expected, locks[i], error});
    csv.rows.push_back({name, formula, expected, locks[i], error});
  }
  out.claims.push_back(at_most("thresholds: largest error", worst, 0.5, "%"));
  out.sections.push_back({"Where it begins to move",
                          "The load grows in " + std::to_string(steps) +
                              " steps past what is expected (the collar's arm shrinks); "
                              "measured is where the part first moves by 0.1 µm or 1 µrad.",
                          {},
                          {table}});
  out.csv.push_back(csv);
}

void add_sliding(const Work& work, Outcome& out) {
  const std::vector<double> mus = work.options.quick ? std::vector<double>{0.3} : std::vector<double>{0.1, 0.3, 0.8};
  const int headings = work.options.quick ? 6 : 24;
  std::vector<Sliding> all(mus.size() * static_cast<std::size_t>(headings));
  work.each("sliding", static_cast<int>(all.size()), [&](int i) {
    all[static_cast<std::size_t>(i)] =
        slide(mus[static_cast<std::size_t>(i / headings)], 0.1 + i % headings * 2 * M_PI / headings);
  });
  std::vector<Slot> slots;
  for (const double play : {5e-6, 20e-6})
    for (const double mu : mus) slots.push_back({play, mu, 0, 0});
  work.each("slot", static_cast<int>(slots.size()), [&](int i) {
    Slot& s = slots[static_cast<std::size_t>(i)];
    s = slide_in_slot(s.play, s.mu);
  });
  Csv csv{
      "sliding", {"mu", "heading_deg", "ratio", "worst_percent", "aside_percent", "gap_change_nm", "turn_urad"}, {}};
  for (const Sliding& s : all)
    csv.rows.push_back(
        {s.mu, 180 / M_PI * s.heading, s.ratio, 100 * s.worst, 100 * s.aside, kNano * s.gap_change, kMicro * s.turn});
  Plot plot{"F_t / (mu N) by heading", {"heading (°)"}, {"F_t / (mu N)"}, {}};
  for (std::size_t m = 0; m < mus.size(); ++m) {
    Series series{"mu " + nlohmann::json(mus[m]).dump(), {}, {}};
    for (int h = 0; h < headings; ++h) {
      const Sliding& s = all[m * static_cast<std::size_t>(headings) + static_cast<std::size_t>(h)];
      series.x.push_back(180 / M_PI * s.heading);
      series.y.push_back(s.ratio);
    }
    plot.series.push_back(series);
  }
  Table table{"A plate in a slot, pressed on one side", {"play (µm)", "mu", "way made (%)", "F_t / (mu N)"}};
  double least = 1, off = 0;
  for (const Slot& s : slots) {
    table.rows.push_back({kMicro * s.play, s.mu, 100 * s.share, s.ratio});
    least = std::min(least, s.share);
    off = std::max(off, std::abs(s.ratio - 1));
  }
  out.claims.push_back(
      at_most("sliding: |F_t / (mu N) - 1|", 100 * largest(all, [](const Sliding& s) { return s.worst; }), 1, "%"));
  out.claims.push_back(at_most("sliding: force across the way, by mu N",
                               100 * largest(all, [](const Sliding& s) { return s.aside; }), 1, "%"));
  out.claims.push_back(at_most("sliding 30 mm at 0.1 m/s: change of the gap",
                               kMicro * largest(all, [](const Sliding& s) { return s.gap_change; }), 0.5, "µm"));
  out.claims.push_back(at_least("slots of 5 and 20 µm play: way made", 100 * least, 99, "%"));
  out.claims.push_back(at_most("slots: |F_t / (mu N) - 1|", 100 * off, 1, "%"));
  out.sections.push_back({"Sliding",
                          "A block is pressed by 1.6 N and led along a floor, then a plate in a slot, at 0.1 m/s.",
                          {plot},
                          {table}});
  out.csv.push_back(csv);
}

void add_jamming(const Work& work, Outcome& out) {
  const int grid = work.options.quick ? 10 : 40;
  struct Map {
    double lambda, mu;
    std::vector<JamPoint> points{};
  };
  std::vector<Map> maps;
  for (const double mu : {0.1, 0.3})
    for (const double lambda : {0.5, 1.0, 2.0}) maps.push_back({lambda, mu});
  work.each("jamming", static_cast<int>(maps.size()), [&](int i) {
    Map& m = maps[static_cast<std::size_t>(i)];
    m.points = jam_map(m.lambda, m.mu, grid);
  });
  Csv csv{"jamming", {"mu", "lambda", "fx_over_fz", "m_over_r_fz", "slides_by_whitney", "slid"}, {}};
  Section section{"Whitney's jamming diagram",
                  "A round peg of 20 mm in its hole (2 µm of play, 64 facets), at the depth 2 r mu lambda, under " +
                      std::to_string(grid * grid) +
                      " loads each. Dots are loads under which the peg's mesh slid in; the diagram says where it does.",
                  {},
                  {}};
  Table table{"", {"mu", "lambda", "depth (mm)", "right (%)"}};
  int right = 0, all = 0;
  for (const Map& m : maps) {
    int good = 0;
    Plot plot{"mu " + nlohmann::json(m.mu).dump() + ", lambda " + nlohmann::json(m.lambda).dump(),
              {"F_x / F_z"},
              {"M / (r F_z)"},
              {}};
    plot.series = {{"slid", {}, {}, {}, {}, true}, {"jammed", {}, {}, {}, {}, true}};
    for (const JamPoint& p : m.points) {
      good += p.slid == p.slides ? 1 : 0;
      Series& s = plot.series[p.slid ? 0 : 1];
      s.x.push_back(p.side);
      s.y.push_back(p.moment);
      csv.rows.push_back({m.mu, m.lambda, p.side, p.moment, p.slides ? 1 : 0, p.slid ? 1 : 0});
    }
    section.plots.push_back(plot);
    table.rows.push_back(
        {m.mu, m.lambda, 1e3 * 2 * kPegRadius * m.mu * m.lambda, 100.0 * good / static_cast<double>(m.points.size())});
    right += good;
    all += static_cast<int>(m.points.size());
  }
  section.tables.push_back(table);
  out.claims.push_back(at_least("Whitney's diagram: points right", 100.0 * right / all, 99, "%"));
  out.sections.push_back(section);
  out.csv.push_back(csv);
}

void add_insertion(const Work& work, Outcome& out) {
  const int points = work.options.quick ? 12 : 60;
  std::vector<PegLead> leads;
  for (const double mu : {0.1, 0.3}) {
    leads.push_back({1e-3, 0, 1e-4, mu});
    if (!work.options.quick) leads.push_back({0, 0.03, 1e-4, mu});
    leads.push_back({1e-3, 0.03, 1e-4, mu});
  }
  std::vector<std::vector<DepthForce>> runs(leads.size());
  work.each("insertion force", static_cast<int>(leads.size()),
            [&](int i) { runs[static_cast<std::size_t>(i)] = insert_peg(leads[static_cast<std::size_t>(i)], points); });
  Csv csv{"insertion_force", {"mu", "offset_mm", "tilt_rad", "depth_mm", "measured_n", "expected_n"}, {}};
  Plot plot{"force against insertion", {"depth (mm)"}, {"force (N)"}, {}};
  double off = 0;
  int reached = 0;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const PegLead& lead = leads[r];
    char name[64];
    std::snprintf(name, sizeof name, "mu %.1f, %.0f mm, %.2f rad", lead.mu, 1e3 * lead.offset, lead.tilt);
    Series measured{name, {}, {}, {}, {}, true}, expected{std::string(name) + ", Whitney", {}, {}, {}, {}, false, true};
    double peak = 0;
    for (const DepthForce& p : runs[r]) peak = std::max(peak, p.expected);
    for (const DepthForce& p : runs[r]) {
      off = std::isnan(p.expected) ? p.expected : std::max(off, std::abs(p.measured - p.expected) / peak);
      measured.x.push_back(1e3 * p.depth);
      measured.y.push_back(p.measured);
      expected.x.push_back(1e3 * p.depth);
      expected.y.push_back(p.expected);
      csv.rows.push_back({lead.mu, 1e3 * lead.offset, lead.tilt, 1e3 * p.depth, p.measured, p.expected});
    }
    reached += static_cast<int>(runs[r].size()) == points ? 1 : 0;
    plot.series.push_back(expected);
    plot.series.push_back(measured);
  }
  out.claims.push_back(at_most("insertion force over depth: off Whitney's, by its peak", 100 * off, 5, "%"));
  out.claims.push_back(at_least("insertion force: runs that reached the depth", reached,
                                static_cast<double>(leads.size()), "of " + std::to_string(leads.size())));
  out.sections.push_back(
      {"Force of an insertion",
       "A peg of 20 mm with 0.1 mm of radial play on the coupling's springs, whose rest pose is off and "
       "tilted, goes into its hole. Dashed: equilibrium in the plane, of one contact or two with "
       "friction (Whitney 1982), for the springs at the peg's center of mass.",
       {plot},
       {}});
  out.csv.push_back(csv);
}

/// `lost` and `late` of the rounds to and fro, `given` on closed ways (J).
void add_rest_claims(int ticks, const std::vector<Creep>& rests, const std::vector<Jitter>& jitters, double lost,
                     double late, const std::vector<double>& given, Outcome& out) {
  const std::string so_many = std::to_string(ticks) + " ticks at rest: ";
  out.claims.push_back(
      at_most(so_many + "creep", kNano * largest(rests, [](const Creep& c) { return c.way; }), 1, "nm"));
  out.claims.push_back(
      at_most(so_many + "turn", kMicro * largest(rests, [](const Creep& c) { return c.turn; }), 1, "µrad"));
  out.claims.push_back(at_most("to and fro: energy lost, off 4 mu N (a - mu N / k)", 100 * lost, 0.5, "%"));
  out.claims.push_back(at_most("to and fro: breaks away, off mu N / k", late, 1.01, "steps of the pen"));
  const std::string off = "a pen off by " + std::to_string(std::lround(kMicro * kPenNoise)) + " µm, ";
  out.claims.push_back(
      at_most(off + "at rest: way", kNano * largest(jitters, [](const Jitter& j) { return j.way; }), 1, "nm"));
  out.claims.push_back(at_most(off + "at rest: change of the force, by stiffness times that",
                               largest(jitters, [](const Jitter& j) { return j.share; }), 1.001, ""));
  out.claims.push_back(at_most(off + "sliding: |F_t / (mu N) - 1|",
                               100 * largest(jitters, [](const Jitter& j) { return j.worst; }), 1, "%"));
  out.claims.push_back(at_most(off + "sliding: goes back",
                               largest(jitters, [](const Jitter& j) { return double(j.back); }), 0, "ticks"));
  out.claims.push_back(at_most("closed ways: the hand gets", *std::max_element(given.begin(), given.end()), 1e-9, "J"));
}

void add_rest(const Work& work, Outcome& out) {
  const std::vector<double> mus = work.options.quick ? std::vector<double>{0.3} : std::vector<double>{0.1, 0.3, 0.8};
  const int ticks = work.options.quick ? 5000 : 100000;
  const auto n = static_cast<int>(mus.size());
  std::vector<Creep> rests(mus.size());
  std::vector<Hysteresis> loops(mus.size());
  std::vector<double> given(mus.size());
  std::vector<Jitter> jitters(mus.size());
  work.each("jitter of the pen", n, [&](int i) {
    jitters[static_cast<std::size_t>(i)] = jitter(mus[static_cast<std::size_t>(i)], work.options.quick ? 2000 : 20000);
  });
  work.each("rest", n,
            [&](int i) { rests[static_cast<std::size_t>(i)] = rest(mus[static_cast<std::size_t>(i)], ticks); });
  work.each("to and fro", n,
            [&](int i) { loops[static_cast<std::size_t>(i)] = to_and_fro(mus[static_cast<std::size_t>(i)]); });
  work.each("closed ways", n,
            [&](int i) { given[static_cast<std::size_t>(i)] = closed_way(mus[static_cast<std::size_t>(i)]); });
  Csv csv{"rest",
          {"mu", "creep_nm", "creep_urad", "loop_j", "loop_expected_j", "breakaway_mm", "breakaway_expected_mm",
           "closed_way_j", "jitter_way_nm", "jitter_share", "jitter_sliding_percent", "jitter_back_ticks"},
          {}};
  Plot plot{"to and fro", {"pen (mm)"}, {"force (N)"}, {}, true};
  Table table{"",
              {"mu", "creep (nm)", "turn (µrad)", "lost in a round (mJ)", "expected (mJ)",
               "the hand gets on a closed way (mJ)", "a pen off by 15 µm: way at rest (nm)",
               "change of the force by k times that", "|F_t / (mu N) - 1| while it slides (%)"}};
  double lost = 0, late = 0;
  for (std::size_t i = 0; i < mus.size(); ++i) {
    const Hysteresis& h = loops[i];
    Series s{"mu " + nlohmann::json(h.mu).dump(), h.pen, h.force};
    thin(s, 500);
    plot.series.push_back(s);
    lost = std::max(lost, std::abs(h.lost / h.expected - 1));
    late = std::max(late, std::abs(h.breakaway - h.breakaway_expected) / h.step);
    const Jitter& j = jitters[i];
    table.rows.push_back({mus[i], kNano * rests[i].way, kMicro * rests[i].turn, 1e3 * h.lost, 1e3 * h.expected,
                          1e3 * given[i], kNano * j.way, j.share, 100 * j.worst});
    csv.rows.push_back({mus[i], kNano * rests[i].way, kMicro * rests[i].turn, h.lost, h.expected, 1e3 * h.breakaway,
                        1e3 * h.breakaway_expected, given[i], kNano * j.way, j.share, 100 * j.worst, j.back});
  }
  add_rest_claims(ticks, rests, jitters, lost, late, given, out);
  out.sections.push_back(
      {"At rest and to and fro",
       "A block is pressed by 1.6 N, pulled to 0.8 of its friction and twisted, and watched; then led to "
       "and fro by 5 mm. Then it is pulled to half, and the pen is off by up to 15 µm along each axis, anew in every "
       "tick.",
       {plot},
       {table}});
  out.csv.push_back(csv);
}

}  // namespace

Outcome friction(const Work& work) {
  Outcome out;
  out.title = "Friction: Coulomb's law against closed forms";
  out.intro =
      "Parts are meshes, moved by the contact loop with the resolver qp, and every motion is certified. The pen is put "
      "where the coupling's springs pull with the load that is asked for.";
  add_thresholds(work, out);
  add_sliding(work, out);
  add_jamming(work, out);
  add_insertion(work, out);
  add_rest(work, out);
  return out;
}

}  // namespace tegotae::experiments
