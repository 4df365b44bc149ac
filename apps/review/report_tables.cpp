#include "review/report_tables.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/number_text.hpp"
#include "shared/format.hpp"

namespace tegotae::review {
namespace {

using apps::format;
using nlohmann::json;

constexpr std::size_t kMaxRows = 200;

json table(const std::string& title, const std::string& text, const std::vector<std::string>& head) {
  return {{"title", title}, {"text", text}, {"head", head}, {"rows", json::array()}};
}

/// The longest episodes, in order of time.
template <typename Episode>
std::vector<Episode> longest(std::vector<Episode> episodes) {
  if (episodes.size() <= kMaxRows) return episodes;
  const auto longer = [](const Episode& a, const Episode& b) { return a.span.length() > b.span.length(); };
  std::nth_element(episodes.begin(), episodes.begin() + kMaxRows, episodes.end(), longer);
  episodes.resize(kMaxRows);
  std::stable_sort(episodes.begin(), episodes.end(),
                   [](const Episode& a, const Episode& b) { return a.span.begin < b.span.begin; });
  return episodes;
}

std::string counted(std::size_t all, const std::string& text) {
  if (all <= kMaxRows) return text;
  return text + (text.empty() ? "" : " ") + "The " + std::to_string(kMaxRows) + " longest of " + std::to_string(all) +
         ".";
}

std::string seconds(double t) {
  return format("%.3f", t);
}
std::string newtons(double f) {
  return fixed_text(f, 2);
}

json clearances(const Review& r) {
  json t = table("Closest parts", "", {"part", "least clearance", "time (s)", "place"});
  if (r.band) t["head"].push_back("band");
  const auto& list = r.findings.clearances;
  for (std::size_t i = 0; i < std::min(kMaxRows, list.size()); ++i) {
    t["rows"].push_back({r.file.scene.parts[list[i].part].name, length_text(list[i].distance), seconds(list[i].t),
                         place_text(list[i].place_W)});
    if (r.band) t["rows"].back().push_back(to_string(r.band->band.zone(list[i].distance)));
  }
  if (list.size() > kMaxRows) t["text"] = format("The closest %zu of %zu.", kMaxRows, list.size());
  return t;
}

/// How much of the path is in which zone of a band.
json band_shares(const BandFindings& f) {
  json t = table("Clearance band", "The nearest part's clearance against " + band_name(f.band) + ".",
                 {"", "for (s)", "of the way"});
  for (const BandZone zone : kBandZones) {
    const auto i = static_cast<std::size_t>(zone);
    t["rows"].push_back({to_string(zone), seconds(f.seconds[i]), length_text(f.way[i])});
  }
  return t;
}

json band_spans(const Review& r) {
  const auto& list = r.band->spans;
  json t = table("Along the path", counted(list.size(), "Tightest: the least clearance meanwhile."),
                 {"band", "from (s)", "to (s)", "from, on the way", "to", "tightest", "part", "at (s)", "place"});
  for (const BandSpan& s : longest(list)) {
    const PartClearance& c = s.tightest;
    const bool near = std::isfinite(c.distance);
    t["rows"].push_back({to_string(s.zone), seconds(s.span.begin), seconds(s.span.end), length_text(s.way_begin),
                         length_text(s.way_end), near ? length_text(c.distance) : "–",
                         near ? r.file.scene.parts[c.part].name : "–", near ? seconds(c.t) : "–",
                         near ? place_text(c.place_W) : "–"});
  }
  return t;
}

json contacts(const Review& r) {
  const auto& list = r.findings.contacts;
  json t = table("Contacts", counted(list.size(), "Where: on the part, at the largest force."),
                 {"part", "from (s)", "to (s)", "for (s)", "largest force (N)", "where", "closest"});
  for (const ContactEpisode& e : longest(list))
    t["rows"].push_back({r.file.scene.parts[e.part].name, seconds(e.span.begin), seconds(e.span.end),
                         seconds(e.span.length()), newtons(e.force), place_text(e.place_W), length_text(e.clearance)});
  return t;
}

json two_sided(const Review& r) {
  const auto& list = r.findings.two_sided;
  json t = table("Held from two sides",
                 counted(list.size(), "Contacts that no translation leaves: pressed, the part wedges."),
                 {"parts", "from (s)", "to (s)", "for (s)", "largest force (N)", "where"});
  for (const TwoSidedEpisode& e : longest(list))
    t["rows"].push_back({names_text(e.parts, r.file.scene), seconds(e.span.begin), seconds(e.span.end),
                         seconds(e.span.length()), newtons(e.force), place_text(e.place_W)});
  return t;
}

json stalls(const Review& r) {
  const auto& list = r.findings.stalls;
  json t = table("Stalls", counted(list.size(), ""),
                 {"by", "from (s)", "to (s)", "for (s)", "pen ahead", "largest force (N)", "where", "on the way"});
  for (const Stall& e : longest(list))
    t["rows"].push_back({e.parts.empty() ? "–" : names_text(e.parts, r.file.scene), seconds(e.span.begin),
                         seconds(e.span.end), seconds(e.span.length()), length_text(e.ahead), newtons(e.force),
                         place_text(e.place_W), r.findings.goal ? length_text(e.depth) : "–"});
  return t;
}

json loads(const Review& r) {
  const Loads& l = r.findings.loads;
  json t = table("Force and torque", "Without limits: what the coupling's springs ask for.",
                 {"", "largest", "at (s)", "without limits", "limit"});
  t["rows"].push_back({"force", format("%.2f N", l.force), seconds(l.force_at), format("%.2f N", l.asked_force),
                       number_text(l.limit_force, 3) + " N"});
  t["rows"].push_back({"torque", format("%.1f mN·m", 1e3 * l.torque), seconds(l.torque_at),
                       format("%.1f mN·m", 1e3 * l.asked_torque), number_text(1e3 * l.limit_torque, 3) + " mN·m"});
  t["rows"].push_back({format("RMS of the force over %.0f s", l.thermal_time), format("%.2f N", l.running_rms), "", "",
                       l.continuous > 0 ? number_text(l.continuous, 3) + " N" : "none"});
  return t;
}

/// What the held part touched or overlapped at the start.
json start(const Review& r) {
  json t = table("At the start",
                 "Relieved: until they had come free, contact was felt so far inside the part's surface. "
                 "Suspended: not kept out until then.",
                 {"part", "", "gap or depth", "felt inside by", "until (s)", "where"});
  for (const StartFinding& f : r.findings.start.pairs) {
    const Clash& c = f.pair.clash;
    const bool relieved = f.pair.state == InitialContactState::shrunk,
               active = f.pair.state == InitialContactState::active;
    t["rows"].push_back({r.file.scene.parts[f.pair.part].name,
                         active     ? "touching"
                         : relieved ? "touching, relieved"
                                    : "overlapping, suspended",
                         c.gap > 0  ? "gap " + length_text(c.gap)
                         : !c.depth ? "open surfaces cross"
                                    : "depth " + length_text(*c.depth),
                         relieved ? length_text(f.pair.inward_offset) : "–",
                         active                   ? "–"
                         : std::isfinite(f.until) ? seconds(f.until)
                                                  : "the end",
                         place_text(c.place_W)});
  }
  return t;
}

/// How much force the assembly takes.
json assembly(const AssemblyForce& f) {
  json t = table(
      "Force of the assembly",
      "The contacts' forces along the way, against the motion. Seating: standing at the deepest. The mean is over "
      "the way.",
      {"", "largest", "at depth", "at (s)", "against", "where", "mean"});
  const auto row = [&t](const char* what, const ForcePeak& p, const std::string& mean) {
    if (p.force > 0)
      t["rows"].push_back(
          {what, newtons(p.force) + " N", length_text(p.depth), seconds(p.t), p.part, place_text(p.place_W), mean});
  };
  const std::string rubs = f.rubs ? format(", %.0f %% friction", 100 * f.friction_share) : "";
  row("insertion", f.insertion, newtons(f.insertion_mean) + " N" + (f.pulled ? "" : rubs));
  row("seating (final)", f.seating, "");
  row("pull-out", f.pull_out, newtons(f.pull_out_mean) + " N" + (f.pulled ? rubs : ""));
  const auto end = [&](double mu, double mean, double depth) {
    t["rows"].push_back({format("%s, mu %.2g", way_force_name(f), mu), "", "to " + length_text(depth), "", "", "",
                         newtons(mean) + " N"});
  };
  if (f.band.high > 0) {
    end(f.band.low, f.low_mean, f.low_depth);
    end(f.band.high, f.high_mean, f.high_depth);
  }
  return t;
}

}  // namespace

json report_tables(const Review& r) {
  json out = json::array({clearances(r)});
  if (r.band) {
    out.push_back(band_shares(*r.band));
    out.push_back(band_spans(r));
  }
  out.push_back(loads(r));
  if (r.assembly.known) out.push_back(assembly(r.assembly));
  if (!r.findings.start.pairs.empty()) out.push_back(start(r));
  if (!r.findings.contacts.empty()) out.push_back(contacts(r));
  if (!r.findings.two_sided.empty()) out.push_back(two_sided(r));
  if (!r.findings.stalls.empty()) out.push_back(stalls(r));
  return out;
}

}  // namespace tegotae::review
