#pragma once

#include <string>

#include "review/assembly_force.hpp"
#include "review/clearance_band.hpp"
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
  std::optional<BandFindings> band;  ///< of the band that was asked for
};

/// What is asked of a review beside the recording.
struct ReviewQuestions {
  std::optional<Pose> goal;           ///< X_WF of the held part; empty: where the scene's script ends
  ForceBand friction;                 ///< see assembly_force()
  std::optional<ClearanceBand> band;  ///< of clearances
};

/// Looks at `recording`, read from `path`, over the scene `file`. Throws Error for a recording that is empty or does
/// not fit the scene.
Review review_recording(const std::string& path, Recording recording, SceneFile file, const ReviewQuestions& questions,
                        const Progress& progress);

/// The verdict, with what else is said of forces and of the band.
Verdict verdict_with_figures(const Review& review);

/// The report, self-contained HTML.
std::string report_html(const Review& review, const Progress& progress);

}  // namespace tegotae::review
