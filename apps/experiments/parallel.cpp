#include "experiments/parallel.hpp"

#include "core/parallel_for.hpp"

namespace tegotae::experiments {

void Work::each(const std::string& what, int n, const std::function<void(int)>& job) const {
  parallel_for(n, options.threads, job,
               [&](int done) { status.say(what + ": " + std::to_string(done) + " of " + std::to_string(n)); });
}

}  // namespace tegotae::experiments
