#pragma once

#include <nanobind/nanobind.h>

#include <atomic>
#include <cstddef>
#include <vector>

#include "review/path_scan.hpp"
#include "tegotae/record/recording.hpp"

namespace tegotae::python {

/// Ends work from outside, at the next progress that it tells.
class Ending {
 public:
  void request() { requested_ = true; }
  bool is_requested() const { return requested_; }
  const std::atomic<bool>* flag() const { return &requested_; }
  /// Throws once the end was requested, what nobody sees: interruptible() raises KeyboardInterrupt then.
  review::Progress watch() const;

 private:
  std::atomic<bool> requested_{false};
};

/// The poses that were looked at, as columns: `t`, `path`, `clearance`, `part` (number of the nearest one, -1: none),
/// `force` and `torque`, and `parts`, their names. Each array owns its numbers.
void add_columns(nanobind::dict& out, const Scene& scene, const std::vector<RecordFrame>& rows,
                 const review::Scan& scan);

}  // namespace tegotae::python
