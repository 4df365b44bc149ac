#pragma once

#include <limits>
#include <vector>

namespace tegotae::bench {

/// Times for one kind of program, µs of CPU time a solve, mean over the instances; NaN where not measured.
struct LpTimes {
  double us = std::numeric_limits<double>::quiet_NaN();       ///< the paper's linear program
  double qp_us = std::numeric_limits<double>::quiet_NaN();    ///< the least-constraint program over the same rows
  double glpk_us = std::numeric_limits<double>::quiet_NaN();  ///< GLPK on the linear program
  double iterations = 0;                                      ///< pivots of the linear program, mean
  double gap = 0;                                             ///< largest relative duality gap |primal - dual| / primal
  double glpk_differs = 0;                                    ///< largest relative difference of GLPK's objective
  int failed = 0;                                             ///< instances that did not end optimal
};

struct LpFigures {
  int n = 0;
  double target_us = 0;
  LpTimes peg;   ///< rings of contacts around a peg in its hole
  LpTimes ball;  ///< random normals, no two alike: more pivots
};

/// 8, 64, 1000 and 10 000 contacts.
std::vector<LpFigures> measure_lp(bool quick);

}  // namespace tegotae::bench
