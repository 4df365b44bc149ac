#include <cmath>
#include <nlohmann/json.hpp>

#include "core/number_text.hpp"
#include "loop/scene_parts.hpp"
#include "plan/plan_output.hpp"
#include "shared/format.hpp"
#include "shared/start_text.hpp"

namespace tegotae::plan {
namespace {

using apps::format;
using OrderedJson = nlohmann::ordered_json;

constexpr double kDegrees = 57.29577951308232;
constexpr std::size_t kMaxListed = 5;  // parts

std::int64_t stops(const Plan& plan) {
  std::int64_t sum = 0;
  for (const PartInTheWay& p : plan.in_the_way) sum += p.stops;
  return sum;
}

/// What is certified, in words.
std::string certificate(const PlanReport& r) {
  std::string text = "every motion of it is proved to leave " + number_text(1e6 * r.plan.clearance, 3) + " um";
  for (const InitialContact& pair : r.plan.start.pairs) {
    const std::string name = '"' + r.file.scene.parts[pair.part].name + '"';
    if (pair.state == InitialContactState::filtered) text += "; " + name + ", in which it starts, was not looked at";
    if (pair.state == InitialContactState::shrunk)
      text += "; to a copy of " + name + " that is smaller by " + number_text(1e6 * pair.inward_offset, 3) +
              " um, for it starts in contact";
  }
  return text;
}

std::string found_text(const PlanReport& r) {
  std::string text =
      format("\"%s\" %s: %s mm and %s degrees, in %zu motion%s\n  ", held_part(r.file.scene).name.c_str(),
             r.to_goal ? "goes to its goal" : "comes out", number_text(1e3 * r.way, 4).c_str(),
             number_text(kDegrees * r.turn, 3).c_str(), r.plan.path.size() - 1, r.plan.path.size() == 2 ? "" : "s") +
      certificate(r) + "\n";
  if (r.plan.interrupted || r.plan.out_of_time)
    text += std::string(r.plan.interrupted ? "  interrupted" : "  the time is up") +
            ": a shorter or wider way was not looked for to the end, and it may leave more than that\n";
  for (std::size_t i = 0; i < std::min(kMaxListed, r.tightest.size()); ++i) {
    const review::PartClearance& c = r.tightest[i];
    text += format("  nearest to \"%s\": %s mm at %.2f s, at", r.file.scene.parts[c.part].name.c_str(),
                   number_text(1e3 * c.distance, 4).c_str(), c.t);
    for (const double m : c.place_W) text += " " + number_text(1e3 * m, 6);
    text += " mm\n";
  }
  if (r.band)
    for (const std::string& line : review::band_text(*r.band, r.tightest, r.file.scene)) text += "  " + line + "\n";
  return text;
}

std::string not_found_text(const PlanReport& r) {
  std::string text =
      format("no way %s was found for \"%s\" in %.1f s (%lld iterations)%s; this is no proof that there is none\n",
             r.to_goal ? "to the goal" : "out", held_part(r.file.scene).name.c_str(), r.plan.seconds,
             static_cast<long long>(r.plan.iterations), r.plan.interrupted ? ", interrupted" : "");
  text += "  it came " + number_text(1e3 * r.plan.way, 4) + " mm from its start at most, and turned by up to " +
          number_text(kDegrees * r.plan.turn, 3) + " degrees\n";
  const double all = static_cast<double>(stops(r.plan));
  for (std::size_t i = 0; i < std::min(kMaxListed, r.plan.in_the_way.size()); ++i) {
    const PartInTheWay& p = r.plan.in_the_way[i];
    const double percent = 100 * static_cast<double>(p.stops) / all;
    text +=
        format("  in the way: \"%s\" stopped %s %% of the motions that were stopped\n",
               r.file.scene.parts[p.part].name.c_str(), percent < 1 ? "less than 1" : format("%.0f", percent).c_str());
  }
  return text;
}

OrderedJson clearance_json(const review::PartClearance& c, const Scene& scene) {
  return {{"part", scene.parts[c.part].name},
          {"distance_m", c.distance},
          {"t", c.t},
          {"place_m", {c.place_W.x(), c.place_W.y(), c.place_W.z()}}};
}

OrderedJson band_json(const review::BandFindings& found, const Scene& scene) {
  OrderedJson j = {{"low_m", found.band.low}, {"high_m", found.band.high}};
  for (const review::BandZone zone : review::kBandZones) {
    const auto i = static_cast<std::size_t>(zone);
    j[to_string(zone)] = {{"seconds", found.seconds[i]}, {"way_m", found.way[i]}};
  }
  j["spans"] = OrderedJson::array();
  for (const review::BandSpan& s : found.spans) {
    OrderedJson span = {{"zone", to_string(s.zone)},
                        {"begin_s", s.span.begin},
                        {"end_s", s.span.end},
                        {"way_begin_m", s.way_begin},
                        {"way_end_m", s.way_end}};
    if (std::isfinite(s.tightest.distance)) span["tightest"] = clearance_json(s.tightest, scene);
    j["spans"].push_back(span);
  }
  return j;
}

}  // namespace

std::string plan_text(const PlanReport& r, const std::string& folder) {
  std::string text = r.plan.found ? found_text(r) : not_found_text(r);
  text += format("  searched: %lld iterations, %zu poses, %lld motions checked, %lld led along contacts, %.2f s\n",
                 static_cast<long long>(r.plan.iterations), r.plan.poses, static_cast<long long>(r.plan.motions),
                 static_cast<long long>(r.plan.complied), r.plan.seconds);
  text += (r.plan.found ? "path: " : "the way to the farthest pose: ") + folder + "\n";
  return text;
}

std::string plan_json(const PlanReport& r) {
  OrderedJson j;
  j["scene"] = r.file.path;
  j["held"] = held_part(r.file.scene).name;
  j["task"] = r.to_goal ? "goal" : "out";
  j["found"] = r.plan.found;
  j["interrupted"] = r.plan.interrupted;
  j["out_of_time"] = r.plan.out_of_time;
  j["clearance_m"] = r.plan.clearance;
  j["motions"] = r.plan.path.size() - 1;
  j["way_m"] = r.way;
  j["turn_rad"] = r.turn;
  j["farthest_m"] = r.plan.way;
  j["farthest_turn_rad"] = r.plan.turn;
  j["tightest"] = OrderedJson::array();
  for (const review::PartClearance& c : r.tightest) j["tightest"].push_back(clearance_json(c, r.file.scene));
  if (r.band) j["band"] = band_json(*r.band, r.file.scene);
  j["in_the_way"] = OrderedJson::array();
  for (const PartInTheWay& p : r.plan.in_the_way)
    j["in_the_way"].push_back({{"part", r.file.scene.parts[p.part].name}, {"stops", p.stops}});
  j["start"] = apps::start_json(r.plan.start, r.file.scene);
  j["searched"] = {{"iterations", r.plan.iterations},
                   {"poses", r.plan.poses},
                   {"motions_checked", r.plan.motions},
                   {"motions_led", r.plan.complied}};
  return j.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
}

}  // namespace tegotae::plan
