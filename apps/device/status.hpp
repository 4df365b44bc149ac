#pragma once

#include <string>

#include "tegotae/device/shm.h"

namespace tegotae::apps {

/// Prints how the device of the segment `name` does, as text or as one line of JSON (docs/programs.md). Returns the
/// exit code; throws Error when there is no such device.
int print_status(const std::string& name, bool json);

/// "force on", or that it is off and why.
std::string state_text(const tegotae_shm_device& pen);
/// Rate, latencies and ticks missed, in lines.
std::string statistics_text(const tegotae_shm_statistics& statistics);

}  // namespace tegotae::apps
