#pragma once

#include <string>

#include "shared/run_options.hpp"

namespace tegotae::apps {

/// The summary as one line of JSON (no newline), fields as in docs/programs.md.
std::string json_line(const RunSummary& summary, const SceneFile& file);

/// The summary for a person; `goal` says in a few words what was to be done.
std::string summary_text(const RunSummary& summary, const RunOptions& options, const SceneFile& file,
                         const std::string& goal, bool interrupted);

}  // namespace tegotae::apps
