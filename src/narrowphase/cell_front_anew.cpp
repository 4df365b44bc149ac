// A cut through the hierarchy that is finer than it needs to be is begun anew.
#include <algorithm>
#include <array>

#include "narrowphase/cell_front.hpp"

namespace tegotae {
namespace {

/// So many cells take longer to renew than a hand waits, or only to go through than they have beside other looks.
constexpr std::uint32_t kManyCells = 1000;
/// All begins anew when the part is so many times as far away as it was, and when pieces that are as thick as this part
/// of the distance would be so many times fewer; not again within so many calls.
constexpr double kFarther = 8, kThickness = 1.0 / 3;
constexpr std::uint32_t kFewer = 4, kPause = 100;

}  // namespace

/// Distance from B that three quarters of a sample of the cells have, by what their planes lost since they were looked
/// at, where enough of them are of parts that are near.
std::optional<double> CellFront::typical_distance() {
  std::array<double, kSample> distance{};
  std::ptrdiff_t n = 0;
  const std::uint32_t stride = count() / kSample + 1;
  for (std::uint32_t slot = 0; slot < count(); slot += stride) {
    const Slot& s = slots_[slot];
    if (asked_[s.part] != now_) continue;
    distance[static_cast<std::size_t>(n++)] = anchored_gap(s.cell, anchors_[slot], sweep_of(s.part), turned_).start;
  }
  if (n < static_cast<std::ptrdiff_t>(kSample) / 2) return std::nullopt;
  const auto quarter = distance.begin() + n / 4;
  std::nth_element(distance.begin(), quarter, distance.begin() + n);
  return *quarter;
}

/// Where A has gone off B, its pieces are smaller than they need to be. To put them together one by one takes as long
/// as all of them last, and a part that runs out of time hovers meanwhile; what begins anew costs the cells that there
/// will be, and faces that come back find theirs.
void CellFront::begin_anew_where_far() {
  if (count() < kManyCells) return;
  const auto typical = typical_distance();
  if (!typical || !(*typical > clearance_ && *typical < reach_)) return;
  nearest_ = std::min(nearest_, *typical);
  if (*typical < kFarther * nearest_ || call_ < begun_ + kPause) return;
  const int pieces = pieces_.at(kThickness * *typical);
  if (kFewer * static_cast<std::uint32_t>(pieces) > count()) return;
  forget_cut();
  for (std::uint32_t part = 0; part < fixed_.size(); ++part)
    if (asked_[part] == now_) enter_root(part);
}

}  // namespace tegotae
