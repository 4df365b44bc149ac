#pragma once

#include <string>

#include "shared/blocker_watch.hpp"
#include "shared/run_options.hpp"

namespace tegotae::apps {

/// The summary as one line of JSON (no newline), fields as in docs/programs.md.
std::string json_line(const RunSummary& summary, const SceneFile& file, const Blocker& blocker);

/// The summary for a person; `goal` says in a few words what was to be done, `blocker` who was in the way at the end.
std::string summary_text(const RunSummary& summary, const RunOptions& options, const SceneFile& file,
                         const std::string& goal, const Blocker& blocker, bool interrupted);

}  // namespace tegotae::apps
