#pragma once

#include <cstdint>
#include <vector>

#include "curve/rises.hpp"
#include "curve/screw_fit.hpp"

namespace tegotae {

/// The surfaces about one axis, each of its own rise: a thread with its chamfers, run-outs and shank. Fitted at once,
/// or what turns without a rise would bend the axis and the rise of the thread. Lengths in the mesh's size.
class AxisFamily {
 public:
  /// No facet, of no rise, and of whatever rise (its normal does not lean along the axis).
  static constexpr std::int8_t kNone = -1, kAny = -2;

  /// Of `facets` those that are `free`; both must outlive this.
  AxisFamily(const std::vector<Facet>& facets, const std::vector<char>& free) : facets_(facets), free_(free) {}

  /// Goes from a motion that a part of the surfaces follows nearly to the axis and its rises. False where there is
  /// none.
  bool settle(const ScrewMotion& near);
  /// The same about an axis that is known, looking for a thread of any rise.
  bool settle_about(const ScrewMotion& plain);

  const ScrewMotion& axis() const { return axis_; }                         ///< the turn without a rise
  const std::vector<double>& rises() const { return rises_; }               ///< of a thread, if there is one, and 0
  std::int8_t rise_of(std::size_t facet) const { return of_rise_[facet]; }  ///< its place in rises(), kAny or kNone
  const ScrewFit& fit() const { return fit_; }                              ///< of all of them together
  double spread() const { return spread_; }                                 ///< rises that differ by less are one

 private:
  bool settle_rounds();
  void collect();
  void collect_leaning();
  void find_rise();
  void assign();
  bool refit();

  const std::vector<Facet>& facets_;
  const std::vector<char>& free_;
  ScrewMotion axis_;
  std::vector<double> rises_;
  std::vector<std::int8_t> of_rise_;
  ScrewFit fit_;
  double rough_ = 0, spread_ = 0;
  std::vector<OwnRise> own_;
  std::vector<std::size_t> near_, of_;
  std::vector<double> weight_, rise_of_;
};

/// Normals within 11° of the axis are those of ends and shoulders, which follow any motion about it.
bool is_end(const Facet& f, const ScrewMotion& m);
/// Whether no other axis fits nearly as well: on a sphere all axes through its center do.
bool is_distinct(const ScrewFit& fit);
/// The turn `plain` with a rise.
ScrewMotion with_rise(ScrewMotion plain, double rise);
/// Facets that lean less than this along the axis (cosine) say nothing about a rise.
inline constexpr double kMinLean = 0.3;
/// Rises are one where they differ by less than this part of the mesh's size.
inline constexpr double kMinSpread = 1e-4;

}  // namespace tegotae
