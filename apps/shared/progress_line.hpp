#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "tegotae/session/session.hpp"

namespace tegotae::apps {

/// A line on stdout, where that is a terminal, that follows a run from its own thread, so that the loop never waits for
/// the terminal. Gone when the object is. After say_progress_in_pipes() also where there is none: lines on stderr.
class ProgressLine {
 public:
  /// On stdout only with `show`.
  ProgressLine(const RunProgress& progress, bool show);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

 private:
  void print() const;
  std::string text() const;

  const RunProgress& progress_;
  const bool terminal_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace tegotae::apps
