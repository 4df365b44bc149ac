#pragma once

#include <string>
#include <vector>

#include "study/shard.hpp"

namespace tegotae::study {

/// What HyperShell is to do.
struct DriverJob {
  std::string study, out;     ///< paths
  std::vector<Shard> shards;  ///< that have something left to do
  int processors = 0;         ///< 0: all
  bool trusted = false;       ///< read meshes in the shards' own processes
};

/// The path of HyperShell's program; throws Error with how to get it, and what to do without, where there is none.
std::string find_driver(const std::string& study);

/// Has HyperShell run `tegotae study` on the shards, a process each; a shard whose process ends otherwise than it
/// should is begun again. Returns when all have ended; false when Ctrl-C ended them. Throws Error when HyperShell
/// cannot be started or fails.
bool drive(const std::string& driver, const DriverJob& job);

}  // namespace tegotae::study
