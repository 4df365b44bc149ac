#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

#include "tegotae/session/session.hpp"

namespace tegotae::apps {

/// A line on stdout that follows a run from its own thread, so that the loop never waits for the terminal. Gone when
/// the object is.
class ProgressLine {
 public:
  /// `depth_offset` (m) is added to the depth shown. Does nothing unless `show`.
  ProgressLine(const RunProgress& progress, double depth_offset, bool show);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

 private:
  void print() const;

  const RunProgress& progress_;
  const double depth_offset_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace tegotae::apps
