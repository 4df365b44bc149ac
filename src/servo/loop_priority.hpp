#pragma once

#include <sched.h>

#include <string>

namespace tegotae {

/// Asks for real-time scheduling of the calling thread, below the servo's, and gives it back at the end.
class LoopPriority {
 public:
  LoopPriority() noexcept;
  ~LoopPriority();
  LoopPriority(const LoopPriority&) = delete;
  LoopPriority& operator=(const LoopPriority&) = delete;

  /// Why it was not granted, in one line; empty when it was.
  std::string missing() const;

 private:
  int policy_ = 0;
  sched_param before_{};
  int error_ = 0;
};

}  // namespace tegotae
