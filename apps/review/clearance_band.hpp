#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "review/findings.hpp"

namespace tegotae::review {

/// Where the gap between the held part and its nearest neighbor is to a band.
enum class BandZone { below, inside, above };

const char* to_string(BandZone zone);
inline constexpr std::array<BandZone, 3> kBandZones = {BandZone::below, BandZone::inside, BandZone::above};

/// Clearances that someone wants: both ends are inside.
struct ClearanceBand {
  double low = 0, high = 0;  ///< m
  BandZone zone(double clearance) const {
    return clearance < low ? BandZone::below : clearance > high ? BandZone::above : BandZone::inside;
  }
};

/// Rows in a row whose nearest part is in one zone.
struct BandSpan {
  BandZone zone = BandZone::inside;
  Span span;                          ///< to where the next one begins
  double way_begin = 0, way_end = 0;  ///< m, that the center of mass had gone along the path
  PartClearance tightest;
};

/// What was found of a band along a path.
struct BandFindings {
  ClearanceBand band;
  std::vector<BandZone> of_row;                  ///< of each of Scan::rows
  std::vector<BandSpan> spans;                   ///< in order of time; they cover the path
  std::array<double, 3> seconds = {}, way = {};  ///< by BandZone: s, m
};

/// `rows` are those of the recording that was scanned.
BandFindings find_band(const ClearanceBand& band, const std::vector<RecordFrame>& rows, const Scan& scan);

/// Lines of text: the share of the path in each zone, the longest segments, and the tightest place of each part.
std::vector<std::string> band_text(const BandFindings& found, const std::vector<PartClearance>& tightest,
                                   const Scene& scene);

/// "0.05 mm to 0.2 mm".
std::string band_name(const ClearanceBand& band);

}  // namespace tegotae::review
