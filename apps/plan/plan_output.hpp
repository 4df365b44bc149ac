#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "plan/planner.hpp"
#include "review/clearance_band.hpp"
#include "review/findings.hpp"
#include "tegotae/record/recording.hpp"
#include "tegotae/scene_file/scene_file.hpp"

namespace tegotae::plan {

/// A path as rows of a recording, one every 10 ms: the part goes at 20 mm/s, turns counted with its radius. `center` of
/// mass of the held part (file frame, m), `radius` of it about that.
std::vector<RecordFrame> path_rows(const std::vector<Pose>& path, const Vec3& center, double radius);

/// The files that write_path() and write_review() make in `folder`.
std::vector<std::string> path_files(const std::string& folder);

/// Writes path.csv, path.glb, script.csv and recording.csv into `folder`. Throws Error.
void write_path(const SceneFile& file, const std::vector<RecordFrame>& rows, const review::Scan& scan,
                const std::optional<review::BandFindings>& band, const std::string& folder);

/// What is said of a plan: for a person, and as JSON (docs/planning.md).
struct PlanReport {
  explicit PlanReport(SceneFile read) : file(std::move(read)) {}

  SceneFile file;  ///< the held part where the path begins
  bool to_goal = false;
  Plan plan;
  double way = 0, turn = 0;                     ///< that the path goes and turns, m, rad
  std::vector<review::PartClearance> tightest;  ///< along the path, by part
  std::optional<review::BandFindings> band;     ///< of the band that was asked for
  std::string folder;
};

/// Writes review.html: the report on the recording that write_path() has written, with the zones of the band. Throws
/// Error.
void write_review(const PlanReport& report, const review::ClearanceBand& band, const review::Progress& progress);

std::string plan_text(const PlanReport& report);
std::string plan_json(const PlanReport& report);

}  // namespace tegotae::plan
