#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tegotae/session/session.hpp"

namespace tegotae::apps {

/// What the held part touched or overlapped at the start, fields as in docs/programs.md.
nlohmann::ordered_json start_json(const InitialContactReport& start, const Scene& scene);

/// The same for a person, a line for each pair, as it is now; empty when the start was free.
std::string start_text(const InitialContactReport& start, const Scene& scene);

/// How a shrunk pair is felt, by InitialContact::inward_offset (m): the words of runs and of the review.
std::string felt_text(double inward_offset);

/// Of each part without clearance that held the held one fast, in words: "by lid: went 3 um where ...".
std::vector<std::string> held_fast_by(const HeldFast& held, const InitialContactReport& start, const Scene& scene);

/// How initial contacts without clearance changed the run, a line a part; empty when they did not.
std::string held_fast_text(const RunSummary& summary, const Scene& scene);
nlohmann::ordered_json held_fast_json(const RunSummary& summary,
                                      const Scene& scene);  ///< the same, of names and lengths

}  // namespace tegotae::apps
