// Judges of a case. They see poses, contacts and what FCL says of the line, and nothing else of the loop.
#pragma once

#include <string>
#include <vector>

#include "families/case_pen.hpp"
#include "families/case_run.hpp"
#include "families/touch_line.hpp"

namespace tegotae::test {

/// What is known of a case without the loop. Lengths in m, along the line beyond the seat.
struct Truth {
  double touch = 0;    ///< where the held part first touches on its line
  double margin = 0;   ///< the pen is farther off than the gap when it is before `touch` by more
  double slack = 0;    ///< a part at rest may stand before `touch` by so much: the gap that is kept
  double follows = 0;  ///< a part whose points are off the pen by less follows it
  double lag = 0;      ///< a lag above this wants a contact that explains it
};

Truth find_truth(const FamilyCase& c, const TouchLine& line);

/// What one tick did.
struct CaseTick {
  Phase phase;
  bool last;     ///< of its phase
  double pen;    ///< m along the line beyond the seat
  double part;   ///< the same of the held part's center
  double off;    ///< m: how far the part is off the pen, at the corner of its box where that is most
  double force;  ///< N: stiffness times how far the center is off the pen, 0 without a contact
  int contacts;
  double gap;  ///< m: the smallest of a contact
};

class Judges {
 public:
  Judges(const FamilyCase& c, const CaseOptions& options, const Truth& truth);

  void look(const CaseTick& tick);
  /// Whether the part follows the pen again, after the last tick.
  bool came_off() const { return came_off_ >= 0 && follows_; }
  int waited() const { return most_unexplained_; }  ///< see CaseResult
  int lifted() const { return came_off_; }
  /// What was wrong, after the last tick. `way`: how far (m) a part that does not follow could go back along its line.
  std::vector<Finding> findings(double way) const;

 private:
  void look_at_force(const CaseTick& tick);
  double least_force() const;
  void judge_rest(std::vector<Finding>& out) const;
  void judge_force(std::vector<Finding>& out) const;

  const FamilyCase& case_;
  CaseOptions options_;
  Truth truth_;
  double stiffness_;
  double worst_free_ = 0;                           // off the pen while that was free
  double rest_ = 0;                                 // where the part rested
  double rest_force_ = 0, settle_force_ = 0;        // when the phase ended
  int without_force_ = 0, most_without_force_ = 0;  // ticks in a row, flat seats
  int unexplained_ = 0, most_unexplained_ = 0;      // ticks in a row
  double unexplained_off_ = 0;                      // the most of them
  int off_after_ = -1;                              // ticks since the pen was free, while the part does not follow
  int came_off_ = -1;
  double away_ = 0;
  bool follows_ = false;  // in the last tick
};

}  // namespace tegotae::test
