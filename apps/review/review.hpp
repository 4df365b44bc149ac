#pragma once

#include <string>

#include "review/assembly_force.hpp"
#include "review/findings.hpp"
#include "review/verdict.hpp"

namespace tegotae::review {

/// A recording, what it is of, and what was found in it.
struct Review {
  std::string path;  ///< of the recording
  SceneFile file;    ///< the held part where the recording begins; the script goes to the goal
  Recording recording;
  Vec3 center;  ///< of mass of the held part, m, file frame
  Scan scan;
  Findings findings;
  Verdict verdict;
  AssemblyForce assembly;
};

/// Looks at `recording`, read from `path`, over the scene `file`. `goal` (X_WF of the held part) replaces where the
/// scene's script ends; `band` is of assembly_force(). Throws Error for a recording that is empty or does not fit the
/// scene.
Review review_recording(const std::string& path, Recording recording, SceneFile file, const std::optional<Pose>& goal,
                        const ForceBand& band, const Progress& progress);

/// The report, self-contained HTML.
std::string report_html(const Review& review, const Progress& progress);

}  // namespace tegotae::review
