#pragma once

#include <optional>
#include <string>
#include <vector>

#include "review/exit_findings.hpp"
#include "review/path_scan.hpp"
#include "review/start_findings.hpp"
#include "shared/blocker.hpp"
#include "tegotae/scene_file/scene_file.hpp"

namespace tegotae::review {

/// An interval of time, s.
struct Span {
  double begin = 0, end = 0;
  double length() const { return end - begin; }
};

/// The held part in contact with another one.
struct ContactEpisode {
  Span span;
  std::size_t part = 0;  ///< index into Scene::parts
  double force = 0;      ///< largest rendered, N
  Vec3 place_W;          ///< of the other part's surface then, m
  double clearance = 0;  ///< least, m
};

/// Contacts that hold the part from two sides at once: it wedges when it is pressed.
struct TwoSidedEpisode {
  Span span;
  std::vector<std::size_t> parts;  ///< in contact meanwhile
  double force = 0;                ///< largest rendered, N
  Vec3 place_W;                    ///< middle of the contacts then, m
};

/// The part stands though the pen is ahead of it.
struct Stall {
  Span span;
  std::vector<std::size_t> parts;  ///< in contact for at least half of the time
  double force = 0;                ///< largest rendered, N
  double ahead = 0;                ///< most that the pen was ahead of the part, m
  Vec3 place_W;                    ///< of a contact in it; of the center of mass where none is known, m
  double depth = 0;                ///< along the way to the goal, m; 0 without a goal
};

/// The least that was measured to a part.
struct PartClearance {
  std::size_t part = 0;
  double distance = 0;  ///< m
  double t = 0;         ///< s
  Vec3 place_W;         ///< middle of the gap, m
};

/// Forces and torques over the recording, N and N·m.
struct Loads {
  double force = 0, torque = 0;              ///< largest rendered
  double force_at = 0, torque_at = 0;        ///< s
  double asked_force = 0, asked_torque = 0;  ///< largest of asked_wrench()
  double running_rms = 0;                    ///< largest RMS of the force over thermal_time (30 s) before each row
  double limit_force = 0, limit_torque = 0, continuous = 0,
         thermal_time = 0;  ///< what holds; continuous 0: not limited
};

/// By what it is judged whether the part went to its goal.
struct GoalRule {
  std::optional<double> tolerance;  ///< m; empty: that of a run of the scene's script
  /// From when on (s) the last pose alone counts, as for the run itself. Empty: a pose counts whenever it was.
  std::optional<double> judged_after;
};

/// Where the part was to go.
struct GoalFindings {
  bool reached = false;        ///< at the end of the recording, as RunSummary::completed has it
  bool passed = false;         ///< at some row
  bool starts_there = false;   ///< at the first row
  bool by_end = false;         ///< GoalRule::judged_after is known, so `passed` does not count
  bool cut = false;            ///< the recording ends before that
  double at = 0;               ///< s: when it was reached first
  double missing = 0;          ///< m: of the center of mass at the end
  double missing_angle = 0;    ///< rad
  double depth = 0, way = 0;   ///< m: gone along the straight way at the end, and its length
  double there_depth = 0;      ///< m: the same as `depth` where the verdict is judged, see judged_row
  std::size_t judged_row = 0;  ///< the last row, or where it was first at its goal if that counts
  double tolerance = 0;        ///< m
};

/// What a recording says about an assembly.
struct Findings {
  double seconds = 0;
  double way = 0, turn = 0;  ///< that the center of mass went and the part turned, m, rad
  std::optional<GoalFindings> goal;
  StartFindings start;                    ///< what it touched or overlapped at the start, and poses that intersect
  ExitFindings exit;                      ///< where it was out of the others, with a goal
  apps::Blocker blocker;                  ///< who was in the way at the end
  std::vector<PartClearance> clearances;  ///< the closest first
  std::vector<ContactEpisode> contacts;
  std::vector<TwoSidedEpisode> two_sided;
  std::vector<Stall> stalls;
  Loads loads;
};

/// What the coupling's springs asked for at a row before any limit, or what was rendered where that is more: the
/// damper's share is not in a recording.
Wrench asked_wrench(const RecordFrame& row, const CouplingSettings& coupling, const Vec3& center);

/// `file`: the scene with the held part where the recording begins, and as script where it was to go.
Findings find(const SceneFile& file, const std::vector<RecordFrame>& rows, const Scan& scan, const Vec3& center,
              const GoalRule& rule = {});

}  // namespace tegotae::review
