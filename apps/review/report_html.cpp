#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "broadphase/bounding_spheres.hpp"
#include "loop/scene_parts.hpp"
#include "review/report_plots.hpp"
#include "review/report_tables.hpp"
#include "review/review.hpp"
#include "review/surface_clearance.hpp"
#include "review/verdict_json.hpp"
#include "view/bundle.hpp"
#include "web/page.hpp"

namespace tegotae::review {
namespace {

using nlohmann::json;

// Of the colored part, and poses that its colors are of.
constexpr std::size_t kMaxTriangles = 8000, kMaxColorPoses = 2000;
constexpr std::size_t kMaxPoses = 3000;  // that the page's part goes through
constexpr std::size_t kGhosts = 9;

/// t and pose of rows, eight numbers each; and which of them are shown as ghosts: evenly along the way.
void add_path(view::Bundle& bundle, const Review& r) {
  const auto& rows = r.recording.frames;
  const double radius = bounding_sphere(*held_part(r.file.scene).mesh).radius;
  std::vector<float> path;
  std::vector<double> way;
  const RecordFrame* last = nullptr;
  for (const std::size_t i : looked_at(rows.size(), kMaxPoses)) {
    const RecordFrame& row = rows[i];
    const Displacement d = last ? displacement(last->x, row.x, r.center) : Displacement();
    way.push_back((way.empty() ? 0 : way.back()) + d.dp.norm() + radius * d.dr.norm());
    last = &row;
    path.push_back(static_cast<float>(row.t));
    for (const double x : row.x.p) path.push_back(static_cast<float>(x));
    for (const double x : {row.x.q.w(), row.x.q.x(), row.x.q.y(), row.x.q.z()}) path.push_back(static_cast<float>(x));
  }
  std::vector<std::uint32_t> ghosts;
  for (std::size_t k = 0; k < kGhosts; ++k) {
    const double at = way.back() * static_cast<double>(k) / (kGhosts - 1);
    const auto found = std::lower_bound(way.begin(), way.end(), at);
    const auto i = static_cast<std::uint32_t>(std::min<std::ptrdiff_t>(found - way.begin(), way.size() - 1));
    if (ghosts.empty() || ghosts.back() != i) ghosts.push_back(i);
  }
  bundle.about["path"] = bundle.add(path);
  bundle.about["ghosts"] = bundle.add(ghosts);
}

/// The band, and where each pose of the path is to it: 0 below, 1 inside, 2 above.
void add_band(view::Bundle& bundle, const Review& r) {
  std::vector<std::uint32_t> zones;
  std::size_t next = 0;  // scanned row
  for (const std::size_t i : looked_at(r.recording.frames.size(), kMaxPoses)) {
    while (next + 1 < r.scan.rows.size() && r.scan.rows[next + 1].row <= i) ++next;
    zones.push_back(static_cast<std::uint32_t>(r.band->of_row[next]));
  }
  bundle.about["band"] = {{"low", r.band->band.low}, {"high", r.band->band.high}, {"zones", bundle.add(zones)}};
}

void add_surface(view::Bundle& bundle, const Review& r, const Progress& progress) {
  const Scene& scene = r.file.scene;
  ColoredSurface surface = sampled_surface(held_part(scene).mesh, kMaxTriangles);
  const std::vector<std::size_t> numbers = looked_at(r.recording.frames.size(), kMaxColorPoses);
  add_clearance(scene, r.recording.frames, numbers, r.scan.reach, progress, surface);
  bundle.about["surface"] = {{"positions", bundle.add(surface.positions)}, {"indices", bundle.add(surface.indices)},
                             {"clearance", bundle.add(surface.clearance)}, {"reach", surface.reach},
                             {"points", surface.positions.size() / 3},     {"poses", numbers.size()}};
}

json place(const char* kind, const std::string& text, const Vec3& at, double t) {
  return {{"kind", kind}, {"text", text}, {"at", {at.x(), at.y(), at.z()}}, {"t", t}};
}

/// What is marked in 3-D.
json places(const Review& r) {
  json out = json::array();
  const Findings& f = r.findings;
  for (const ContactEpisode& e : f.contacts)
    out.push_back(place("contact", "contact with " + r.file.scene.parts[e.part].name, e.place_W, e.span.begin));
  for (const TwoSidedEpisode& e : f.two_sided)
    out.push_back(place("two-sided", "held from two sides", e.place_W, e.span.begin));
  for (const Stall& e : f.stalls) out.push_back(place("stall", "stalled", e.place_W, e.span.begin));
  return out;
}

json notes(const Review& r) {
  json out = json::array();
  const std::size_t n = r.recording.frames.size();
  out.push_back("Clearances are distances between the triangles of the parts, measured at " +
                (r.scan.every == 1 ? "each of " + std::to_string(n) + " rows"
                                   : "every " + std::to_string(r.scan.every) + "th of " + std::to_string(n) + " rows") +
                " of the recording; to parts that are not the nearest they are known below " +
                length_text(r.scan.reach) + ".");
  out.push_back(
      "A recording has no contacts: a contact loop follows its poses, and goes up to 50 µm on towards the "
      "pen. A part is in contact when its gap is below the contact gap of that loop (" +
      length_text(r.scan.rows.front().contact_gap) +
      " at the start). Held from two sides: no translation "
      "leaves all contacts.");
  out.push_back("A stall: slower than 1 mm/s for 0.2 s or more while the pen is more than 0.5 mm ahead.");
  return out;
}

}  // namespace

std::string report_html(const Review& r, const Progress& progress) {
  view::Bundle bundle;
  view::add_scene(bundle, r.file.scene, r.center);
  bundle.about["title"] = held_part(r.file.scene).name + ": " + std::filesystem::path(r.path).filename().string();
  bundle.about["subtitle"] = std::filesystem::path(r.file.path).filename().string() +
                             (r.recording.info.program.empty() ? "" : ", " + r.recording.info.program);
  bundle.about["verdict"] = verdict_json(r.verdict);
  add_path(bundle, r);
  if (r.band) add_band(bundle, r);
  add_surface(bundle, r, progress);
  bundle.about["places"] = places(r);
  bundle.about["plots"] = report_plots(r);
  bundle.about["tables"] = report_tables(r);
  bundle.about["notes"] = notes(r);
  return apps::review_page(bundle.bytes());
}

}  // namespace tegotae::review
