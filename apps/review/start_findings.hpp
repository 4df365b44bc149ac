#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "review/path_scan.hpp"
#include "tegotae/loop/initial_contacts.hpp"

namespace tegotae::review {

/// A part that the held one touched or overlapped at the start.
struct StartFinding {
  InitialContact pair;  ///< as it was at the start
  /// When a relieved or suspended pair had come free, s; infinite: not in this recording.
  double until = std::numeric_limits<double>::infinity();
  /// Poses before that reach into the part by more than it was relieved of; of a suspended one poses that intersect it.
  std::int64_t deeper = 0;
};

struct StartFindings {
  std::vector<StartFinding> pairs;
  double shift = 0;               ///< InitialContactReport::shift
  std::int64_t intersecting = 0;  ///< poses that intersect a part after it had come free, or one that was free
};

/// Asks FCL about every pose (of more than PoseCheck::kMax every second, ...), about parts that were relieved or
/// suspended (Scan::start) from when they had come free on.
StartFindings find_start(const Scene& scene, const std::vector<RecordFrame>& rows, const Scan& scan);

}  // namespace tegotae::review
