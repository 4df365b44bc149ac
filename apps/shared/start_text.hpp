#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tegotae/session/session.hpp"

namespace tegotae::apps {

/// What the held part touched or overlapped at the start, fields as in docs/programs.md.
nlohmann::ordered_json start_json(const InitialContactReport& start, const Scene& scene);

/// The same for a person, a line for each pair, as it is now; empty when the start was free.
std::string start_text(const InitialContactReport& start, const Scene& scene);

/// How initial contacts without clearance changed the run, a line a part; empty when they did not.
std::string held_fast_text(const RunSummary& summary, const Scene& scene);
nlohmann::ordered_json held_fast_json(const RunSummary& summary,
                                      const Scene& scene);  ///< the same, of names and lengths

}  // namespace tegotae::apps
