// One case of a family: the loop follows the pen, and judges that know nothing of the loop say what was wrong.
#pragma once

#include <string>
#include <vector>

#include "families/family.hpp"

namespace tegotae::test {

struct CaseOptions {
  bool real_time = false;  ///< the default tick budget; otherwise bounded by work alone
  std::string trace;       ///< file for a line of CSV a tick; empty: none
};

/// Something that was not as it should be.
struct Finding {
  std::string what, seen, expected;
};

struct CaseResult {
  FamilyParameters parameters;  ///< as used: the clearance bounded, the parts counted
  std::vector<Finding> findings;
  int triangles = 0;  ///< of all parts, instances counted
  int cut = 0;        ///< ticks
  int waited = 0;     ///< ticks in a row, at most, in which the part was held back without a contact
  int lifted = 0;     ///< ticks until the part followed the pen when it was lifted; below 0: it never did
  double seconds_loop = 0, seconds_judges = 0;
};

CaseResult run_case(const FamilyParameters& parameters, const CaseOptions& options);

/// "wave seed=3 triangles=7000 …" as the program `families` takes it back, "--family wave --seed 3 …".
std::string describe(const FamilyParameters& parameters, const CaseOptions& options);
std::string arguments(const FamilyParameters& parameters, const CaseOptions& options);

}  // namespace tegotae::test
