#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tegotae/sim/scene.hpp"
#include "tegotae/sim/start.hpp"

namespace tegotae::apps {

/// What the held part touched or overlapped at the start, fields as in docs/programs.md.
nlohmann::ordered_json start_json(const StartReport& start, const Scene& scene);

/// The same for a person, a line for each pair, as it is now; empty when the start was free.
std::string start_text(const StartReport& start, const Scene& scene);

}  // namespace tegotae::apps
