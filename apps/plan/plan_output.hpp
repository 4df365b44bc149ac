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

/// What is said of a plan: for a person, and as JSON (docs/planning.md).
struct PlanReport {
  explicit PlanReport(SceneFile read) : file(std::move(read)) {}

  SceneFile file;  ///< the held part where the path begins
  bool to_goal = false;
  Plan plan;
  std::vector<RecordFrame> rows;                ///< the path in time
  review::Scan scan;                            ///< what is near to it
  double way = 0, turn = 0;                     ///< that the path goes and turns, m, rad
  std::vector<review::PartClearance> tightest;  ///< along the path, by part
  std::optional<review::BandFindings> band;     ///< of the band that was asked for
};

/// Looks at the path that `report` has, and fills in what follows from it. Throws Error.
void measure(PlanReport& report, const std::optional<review::ClearanceBand>& band, const review::Progress& progress);

/// The files that write_plan() makes in `folder`.
std::vector<std::string> plan_files(const std::string& folder);

/// Writes them; review.html only with a band: the report on the recording, with its zones. What an earlier plan wrote
/// and this one does not is removed. Throws Error.
void write_plan(const PlanReport& report, const std::string& folder, const review::Progress& progress);

/// `folder` has the files.
std::string plan_text(const PlanReport& report, const std::string& folder);
std::string plan_json(const PlanReport& report);

}  // namespace tegotae::plan
