#include "shared/start_text.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/number_text.hpp"
#include "shared/format.hpp"

namespace tegotae::apps {

namespace {

const char* state_name(InitialContactState state) {
  switch (state) {
    case InitialContactState::shrunk:
      return "relieved";
    case InitialContactState::filtered:
      return "suspended";
    default:
      return "active";
  }
}

std::string length(double m) {
  return m < 1e-3 ? fixed_text(1e6 * m, 2) + " um" : fixed_text(1e3 * m, 3) + " mm";
}

/// The initial contact of the pair, and how the run treats it.
std::string line(const InitialContact& pair, const Scene& scene) {
  const Clash& c = pair.clash;
  const bool overlap = c.kind == ClashKind::overlap;
  std::string text = format("  %-12s ", overlap ? "overlapping" : "touching") + scene.parts[pair.part].name;
  text += !c.depth ? ", open surfaces cross" : c.gap > 0 ? ", gap " + length(c.gap) : ", depth " + length(*c.depth);
  if (pair.state == InitialContactState::filtered)
    return text + "; SUSPENDED: until they have come free, nothing keeps the two apart\n";
  if (pair.state == InitialContactState::shrunk)
    return text + "; until they have come free, " + felt_text(pair.inward_offset) + "\n";
  if (pair.freed > 0) return text + "; came free\n";
  return text + "\n";
}

}  // namespace

std::string felt_text(double inward_offset) {
  return "contact is felt " + length(inward_offset) + " inside its surface";
}

nlohmann::ordered_json start_json(const InitialContactReport& start, const Scene& scene) {
  nlohmann::ordered_json pairs = nlohmann::ordered_json::array(), suspended = nlohmann::ordered_json::array();
  for (const InitialContact& pair : start.pairs) {
    const Clash& c = pair.clash;
    const std::string& name = scene.parts[pair.part].name;
    if (pair.state == InitialContactState::filtered) suspended.push_back(name);
    pairs.push_back({{"part", name},
                     {"start", c.kind == ClashKind::overlap ? "overlapping" : "touching"},
                     {"gap_m", c.gap},
                     {"depth_m", c.depth ? nlohmann::ordered_json(*c.depth) : nlohmann::ordered_json()},
                     {"place_m", {c.place_W.x(), c.place_W.y(), c.place_W.z()}},
                     {"relief_m", pair.inward_offset},
                     {"state", state_name(pair.state)}});
  }
  return {{"shift_m", start.shift}, {"pairs", pairs}, {"suspended", suspended}};
}

std::string start_text(const InitialContactReport& start, const Scene& scene) {
  std::string text;
  for (const InitialContact& pair : start.pairs) text += line(pair, scene);
  if (start.shift > 0)
    text += format("  %-12s moved by ", "start") + length(start.shift) + " away from what it touches\n";
  return text;
}

std::vector<std::string> held_fast_by(const HeldFast& h, const InitialContactReport& start, const Scene& scene) {
  std::vector<std::string> out;
  for (const InitialContact& pair : start.pairs) {
    if (std::find(h.parts.begin(), h.parts.end(), pair.part) == h.parts.end()) continue;
    out.push_back("by " + scene.parts[pair.part].name + ": went " + length(h.moved) + " where its pen went " +
                  length(h.pen) + "; the fit has no clearance, even with contact felt " + length(pair.inward_offset) +
                  " inside that part's surface");
  }
  return out;
}

std::string held_fast_text(const RunSummary& summary, const Scene& scene) {
  std::string text;
  for (const std::string& by : held_fast_by(summary.held_fast, summary.start, scene))
    text += format("  %-12s ", "HELD FAST") + by + "\n";
  return text;
}

nlohmann::ordered_json held_fast_json(const RunSummary& summary, const Scene& scene) {
  nlohmann::ordered_json names = nlohmann::ordered_json::array();
  for (const std::size_t part : summary.held_fast.parts) names.push_back(scene.parts[part].name);
  return {{"parts", names}, {"moved_m", summary.held_fast.moved}, {"pen_m", summary.held_fast.pen}};
}

}  // namespace tegotae::apps
