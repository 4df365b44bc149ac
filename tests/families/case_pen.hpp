// The pen of a case: along its line to the seat and beyond, aside, turned, off and on again beside the line, and back;
// the same case, the same pen.
#pragma once

#include "families/family.hpp"
#include "tegotae/device/script.hpp"

namespace tegotae::test {

enum class Phase { approach, rest, slide, turn, jabs, settle, lift, away };

class CasePen {
 public:
  /// `rest_ticks`: how long the pen rests where it presses.
  CasePen(const FamilyCase& c, int rest_ticks);

  int ticks() const { return ends_.back(); }
  /// Of a tick, one each millisecond.
  Phase phase(int tick) const;
  /// Whether `tick` is the last one of its phase.
  bool last(int tick) const { return tick + 1 == ticks() || phase(tick + 1) != phase(tick); }
  Pose pose(int tick) const { return script_.pose(1e-3 * tick); }

 private:
  std::vector<int> ends_;  // of the phases
  StylusScript script_;
};

}  // namespace tegotae::test
