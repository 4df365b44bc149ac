#include "review/clearance_band.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/number_text.hpp"
#include "review/verdict.hpp"
#include "shared/format.hpp"

namespace tegotae::review {
namespace {

using apps::format;

constexpr std::size_t kMaxSpans = 10, kMaxParts = 10;  // that are printed

std::size_t index(BandZone zone) {
  return static_cast<std::size_t>(zone);
}

/// The zone of a row: that of the nearest part; without any the gap is endless.
BandZone zone_of(const ScannedRow& row, const ClearanceBand& band) {
  return row.clearances.empty() ? BandZone::above : band.zone(row.clearances.front().distance);
}

void take_tightest(const ScannedRow& row, double t, PartClearance& tightest) {
  if (row.clearances.empty() || row.clearances.front().distance >= tightest.distance) return;
  const Clearance& c = row.clearances.front();
  tightest = {c.part, c.distance, t, 0.5 * (c.on_held_W + c.on_other_W)};
}

std::string tightest_text(const PartClearance& c, const Scene& scene) {
  return length_text(c.distance) + " to " + scene.parts[c.part].name + " at " + place_text(c.place_W) + ", after " +
         seconds_text(c.t);
}

std::string span_text(const BandSpan& s, const Scene& scene) {
  std::string text = format("%s the band from %.3f to %.3f s, ", to_string(s.zone), s.span.begin, s.span.end) +
                     fixed_text(1e3 * s.way_begin, 2) + " to " + fixed_text(1e3 * s.way_end, 2) + " mm on the way";
  return std::isfinite(s.tightest.distance) ? text + ": at least " + tightest_text(s.tightest, scene) : text;
}

}  // namespace

const char* to_string(BandZone zone) {
  return zone == BandZone::below ? "below" : zone == BandZone::inside ? "inside" : "above";
}

std::string band_name(const ClearanceBand& band) {
  return length_text(band.low) + " to " + length_text(band.high);
}

BandFindings find_band(const ClearanceBand& band, const std::vector<RecordFrame>& rows, const Scan& scan) {
  BandFindings out;
  out.band = band;
  double way = 0;
  for (std::size_t i = 0; i < scan.rows.size(); ++i) {
    const ScannedRow& row = scan.rows[i];
    const RecordFrame& frame = rows[row.row];
    const BandZone zone = zone_of(row, band);
    out.of_row.push_back(zone);
    if (out.spans.empty() || out.spans.back().zone != zone)
      out.spans.push_back(
          {zone, {frame.t, frame.t}, way, way, {0, std::numeric_limits<double>::infinity(), 0, Vec3::Zero()}});
    BandSpan& span = out.spans.back();
    take_tightest(row, frame.t, span.tightest);
    if (i + 1 == scan.rows.size()) break;
    // Up to the next row it counts as here.
    const RecordFrame& next = rows[scan.rows[i + 1].row];
    const double gone = displacement(frame.x, next.x, scan.center).dp.norm();
    way += gone;
    span.span.end = next.t;
    span.way_end = way;
    out.seconds[index(zone)] += next.t - frame.t;
    out.way[index(zone)] += gone;
  }
  return out;
}

std::vector<std::string> band_text(const BandFindings& found, const std::vector<PartClearance>& tightest,
                                   const Scene& scene) {
  std::string text = "clearance of " + band_name(found.band) + ": ";
  for (const BandZone zone : kBandZones)
    text += format("%s%s %.2f s and %.2f mm", zone == BandZone::below ? "" : ", ", to_string(zone),
                   found.seconds[index(zone)], 1e3 * found.way[index(zone)]);
  std::vector<std::string> out = {text};
  std::vector<BandSpan> spans;
  for (const BandSpan& s : found.spans)
    if (s.zone != BandZone::above) spans.push_back(s);
  if (spans.size() > kMaxSpans) {
    const auto tighter = [](const BandSpan& a, const BandSpan& b) { return a.tightest.distance < b.tightest.distance; };
    std::nth_element(spans.begin(), spans.begin() + kMaxSpans, spans.end(), tighter);
    out.push_back(format("the tightest %zu of %zu segments in it or below:", kMaxSpans, spans.size()));
    spans.resize(kMaxSpans);
    std::sort(spans.begin(), spans.end(),
              [](const BandSpan& a, const BandSpan& b) { return a.span.begin < b.span.begin; });
  }
  for (const BandSpan& s : spans) out.push_back(span_text(s, scene));
  for (std::size_t i = 0; i < std::min(kMaxParts, tightest.size()); ++i)
    out.push_back("tightest: " + tightest_text(tightest[i], scene) + ", " +
                  to_string(found.band.zone(tightest[i].distance)) + " the band");
  return out;
}

}  // namespace tegotae::review
