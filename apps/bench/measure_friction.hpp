#pragma once

#include <limits>
#include <vector>

#include "tegotae/core/latency_histogram.hpp"

namespace tegotae::bench {

/// Solves of Coulomb's law for random parts that are pulled into their contacts, CPU time of each.
struct FrictionSolveFigures {
  int contacts = 0;
  double target_us = std::numeric_limits<double>::quiet_NaN();  ///< of the median
  LatencySummary us{};
  double exact = 0;  ///< share that ended at the law
};

/// 2, 8, 20 and 64 contacts; mu from 0.15 to 0.8.
std::vector<FrictionSolveFigures> measure_friction_solves(bool quick);

}  // namespace tegotae::bench
