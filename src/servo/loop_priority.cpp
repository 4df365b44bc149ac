#include "servo/loop_priority.hpp"

#include <pthread.h>

#include <cstring>

namespace tegotae {

namespace {

// Below the servo (80): a tick that takes long never holds it up. Threads that the thread makes meanwhile inherit it.
constexpr int kLoopPriority = 70;

}  // namespace

LoopPriority::LoopPriority() noexcept {
  error_ = pthread_getschedparam(pthread_self(), &policy_, &before_);
  sched_param wanted{};
  wanted.sched_priority = kLoopPriority;
  if (error_ == 0) error_ = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted);
}

LoopPriority::~LoopPriority() {
  if (error_ == 0) pthread_setschedparam(pthread_self(), policy_, &before_);
}

std::string LoopPriority::missing() const {
  return error_ == 0 ? std::string() : std::string("contact loop: SCHED_FIFO: ") + std::strerror(error_);
}

}  // namespace tegotae
