#pragma once

#include <cstdint>

#include "tegotae/core/clock.hpp"

namespace tegotae {

/// How much one call of a path certificate may do.
struct WorkLimit {
  int searches = 8192;                     ///< searches for a plane; about 0.2 µs each
  std::uint32_t blocking = 0xffffffffu;    ///< blocking triangle pairs after which to stop
  std::int64_t deadline_ns = kNoDeadline;  ///< of monotonic_ns()
};

enum class CertifyStatus : std::uint8_t {
  certified,     ///< the whole motion is free
  blocked,       ///< some triangle pairs have no moving plane that separates them: they are listed
  out_of_budget  ///< work, time or a capacity ran out before anything was found to block
};

/// What one call of a path certificate did.
struct CertifyReport {
  CertifyStatus status = CertifyStatus::certified;
  double share = 0;        ///< part of the motion, from its start, that is certified free; 1 when all of it is
  bool overflow = false;   ///< a capacity was exceeded
  bool exhausted = false;  ///< work or time ran out (with `blocked`: the list may lack pairs)
  int pairs = 0;           ///< pairs or cells in the front after the call
  int searches = 0;        ///< planes searched
  int splits = 0, merges = 0;
};

}  // namespace tegotae
