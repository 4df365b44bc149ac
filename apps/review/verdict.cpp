#include "review/verdict.hpp"

#include <algorithm>
#include <cmath>

#include "core/number_text.hpp"
#include "core/numbers.hpp"
#include "shared/format.hpp"
#include "shared/start_text.hpp"

namespace tegotae::review {

using apps::format;

namespace {

std::string times(std::size_t n) {
  return n == 1 ? "once" : format("%zu times", n);
}

class Judge {
 public:
  Judge(const Findings& f, const Scene& scene, bool inwards, const Scan& scan)
      : f_(f), scene_(scene), inwards_(inwards), scan_(scan) {}

  Verdict verdict(const std::string& damage) {
    const Headline h = headline(f_, scene_, inwards_);
    v_.outcome = h.outcome;
    v_.headline = h.text;
    if (f_.goal) report_goal();
    report_intersections();
    report_start();
    report_held_fast();
    report_clearance();
    report_loads();
    report_contacts();
    if (!damage.empty()) bad("The end of the recording is missing: " + damage + ".");
    return v_;
  }

 private:
  void add(Evidence::Kind kind, const std::string& text) { v_.evidence.push_back({kind, text}); }
  void good(const std::string& text) { add(Evidence::Kind::good, text); }
  void bad(const std::string& text) { add(Evidence::Kind::bad, text); }
  void plain(const std::string& text) { add(Evidence::Kind::plain, text); }

  void report_goal() {
    const GoalFindings& g = *f_.goal;
    const std::string text =
        format("At the end it is %s and %.1f° from its goal (tolerance %s, 5.7°), %s of %s on the way.",
               length_text(g.missing).c_str(), g.missing_angle / kDegree, length_text(g.tolerance).c_str(),
               length_text(g.depth).c_str(), length_text(g.way).c_str());
    add(g.reached ? Evidence::Kind::good : Evidence::Kind::bad, text);
    if (g.passed && g.by_end && !g.reached && !g.starts_there)
      bad("It was at its goal after " + seconds_text(g.at) + ", and did not stay.");
  }

  const std::string& name(const StartFinding& f) const { return scene_.parts[f.pair.part].name; }
  static bool was_active(const StartFinding& f) { return f.pair.state == InitialContactState::active; }

  void report_intersections() {
    const auto& pairs = f_.start.pairs;
    if (f_.start.intersecting == 0)
      good(std::string("No pose intersects another part") +
           (std::all_of(pairs.begin(), pairs.end(), was_active) ? "" : " that was free of it") +
           ", by their triangles, checked independently of the run.");
    else
      bad(format("%lld poses intersect another part.", static_cast<long long>(f_.start.intersecting)));
  }

  void report_start() {
    std::vector<std::size_t> touching;
    for (const StartFinding& f : f_.start.pairs)
      if (was_active(f)) touching.push_back(f.pair.part);
    if (!touching.empty())
      plain("Touching at the start: " + names_text(touching, scene_) +
            (f_.start.shift > 0 ? "; the part was moved by " + length_text(f_.start.shift) + " to part them." : "."));
    for (const StartFinding& f : f_.start.pairs) {
      const std::string until = std::isfinite(f.until) ? " until " + seconds_text(f.until) : " to the end";
      const std::string poses = format("%lld poses", static_cast<long long>(f.deeper));
      if (f.pair.state == InitialContactState::filtered)
        bad(format("Suspended%s, because the part began in it: %s. Nothing kept the part out of it; %s intersect it.",
                   until.c_str(), name(f).c_str(), poses.c_str()));
      if (f.pair.state == InitialContactState::shrunk)
        add(f.deeper == 0 ? Evidence::Kind::plain : Evidence::Kind::bad,
            "Touching at the start: " + name(f) + ";" + until + " " + apps::felt_text(f.pair.inward_offset) + "; " +
                (f.deeper == 0 ? "no pose" : poses) + " reached deeper.");
    }
  }

  void report_held_fast() {
    for (const std::string& by : apps::held_fast_by(scan_.held_fast, scan_.start, scene_))
      add(v_.outcome == Outcome::does_not_go ? Evidence::Kind::bad : Evidence::Kind::plain, "Held fast " + by + ".");
  }

  void report_clearance() {
    if (f_.clearances.empty()) return;
    const PartClearance& c = f_.clearances.front();
    plain("Least clearance " + length_text(c.distance) + " to " + scene_.parts[c.part].name + " at " +
          place_text(c.place_W) + ", after " + seconds_text(c.t) + ".");
  }

  void report_loads() {
    const Loads& l = f_.loads;
    const bool within = l.asked_force <= l.limit_force && l.asked_torque <= l.limit_torque;
    const std::string text =
        format("At most %.2f N (limit %s N) and %.0f mN·m (limit %s mN·m); without limits %.2f N and %.0f mN·m.",
               l.force, number_text(l.limit_force, 2).c_str(), 1e3 * l.torque,
               number_text(1e3 * l.limit_torque, 3).c_str(), l.asked_force, 1e3 * l.asked_torque);
    add(within ? Evidence::Kind::good : Evidence::Kind::bad, text);
    if (l.continuous > 0)
      add(l.running_rms <= 0.999 * l.continuous ? Evidence::Kind::good : Evidence::Kind::bad,
          format("Running RMS over %.0f s at most %.2f N; the motors sustain %s N.", l.thermal_time, l.running_rms,
                 number_text(l.continuous, 2).c_str()));
  }

  void report_contacts() {
    if (f_.contacts.empty()) plain("Nothing was touched.");
    if (!f_.two_sided.empty()) {
      double total = 0;
      for (const TwoSidedEpisode& e : f_.two_sided) total += e.span.length();
      plain("Held from two sides " + times(f_.two_sided.size()) +
            format(", %.2f s together: it wedges when it is pressed.", total));
    }
    if (f_.stalls.empty()) return plain("It never stalled.");
    const auto longest = std::max_element(f_.stalls.begin(), f_.stalls.end(), [](const Stall& a, const Stall& b) {
      return a.span.length() < b.span.length();
    });
    const std::string by = longest->parts.empty() ? "" : ", touching " + names_text(longest->parts, scene_);
    plain("Stalled " + times(f_.stalls.size()) +
          format(", longest for %.2f s after %.2f s", longest->span.length(), longest->span.begin) + by + " at " +
          place_text(longest->place_W) + ".");
  }

  const Findings& f_;
  const Scene& scene_;
  bool inwards_;
  const Scan& scan_;
  Verdict v_;
};

}  // namespace

std::string length_text(double meters) {
  const double size = std::abs(meters);
  if (size < 1e-4) return number_text(1e6 * meters, 3) + " µm";
  return size < 1 ? number_text(1e3 * meters, 3) + " mm" : number_text(meters, 3) + " m";
}

std::string seconds_text(double seconds) {
  return format("%.2f s", seconds);
}

std::string names_text(const std::vector<std::size_t>& parts, const Scene& scene) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i)
    text += (i == 0 ? "" : i + 1 == parts.size() ? " and " : ", ") + scene.parts[parts[i]].name;
  return text;
}

Verdict judge(const Findings& findings, const Scene& scene, bool inwards, const Scan& scan, const std::string& damage) {
  return Judge(findings, scene, inwards, scan).verdict(damage);
}

}  // namespace tegotae::review
