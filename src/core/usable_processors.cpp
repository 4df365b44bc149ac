#include "core/usable_processors.hpp"

#include <sched.h>

#include <algorithm>
#include <thread>

namespace tegotae {

int usable_processors() noexcept {
  cpu_set_t set;
  // A machine of more processors than the set has room for refuses.
  if (sched_getaffinity(0, sizeof set, &set) == 0) return std::max(1, CPU_COUNT(&set));
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace tegotae
