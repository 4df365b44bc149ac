#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tegotae/core/contact_force.hpp"
#include "tegotae/core/export.hpp"
#include "tegotae/core/lag_reason.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// One row of a recording: one certified sub-step of a tick of the contact loop.
struct RecordFrame {
  std::uint64_t tick = 0;                  ///< number of the contact loop's tick
  std::uint32_t substep = 0;               ///< number of the sub-step in its tick, from 0
  double t = 0;                            ///< time of the tick, s
  Pose y;                                  ///< Y: where the pen wants the held part's file frame, in the world
  Pose x;                                  ///< X: where the held part's file frame is, in the world
  Wrench wrench;                           ///< on the pen, at the held part's center of mass, N and N·m
  int contacts = 0;                        ///< TickReport::contacts
  double gap = 0;                          ///< smallest known gap, m; +inf when nothing is near
  double tick_us = 0;                      ///< time that the tick took, µs; 0 in virtual time
  LagReason lag_reason = LagReason::none;  ///< TickReport::lag_reason; none in older recordings without it
  ContactForces forces{};                  ///< TickReport::forces at the end of the tick; in MCAP only
};

/// Metadata of a recording. With it a program can show the recording with its parts. Unknown texts are empty.
struct RecordingInfo {
  std::string scene;     ///< path of the scene file, as the recording program saw it or from the recording's folder
  std::string held;      ///< name of the held part
  std::string resolver;  ///< name of the resolver
  std::string program;   ///< name and version of the program that wrote it
  /// Names of the parts that the held part overlapped at the start, and from which nothing keeps it apart, with ", "
  /// between them.
  std::string filtered{};
  std::string continues{};     ///< the recording beside it that it continues: the scene changed there
  std::string continued_by{};  ///< the recording beside it that continues it: the scene changed there
  std::string guide{};         ///< path of the file whose path guided the hand
  std::string goal{};          ///< pose X_WF to which script or hand were to bring the held part: X,Y,Z,QW,QX,QY,QZ, m
  std::string goal_tolerance{};  ///< largest distance of its center of mass from the goal, m; see RunSummary::completed
  /// Time (s) from which on the part's last pose says whether the run is completed. Empty: a person led the pen, and
  /// may have been at the goal at any time.
  std::string judged_after{};
};

/// A recording in memory.
struct Recording {
  RecordingInfo info;               ///< its metadata
  std::vector<RecordFrame> frames;  ///< rows, in the order of the file
  std::string damage;               ///< fault of its end (e.g. that the last row is incomplete); empty when it is whole
};

/// Reads a recording of Recorder: MCAP when the file begins like one, otherwise CSV. It finds CSV columns by name, in
/// any order, and skips other columns and lines that begin with #. Of a recording without its end it reads what there
/// is (Recording::damage). For any other fault it throws Error (kind file): `file:line: column: reason` (CSV) or `file:
/// at byte N: reason` (MCAP).
Recording read_recording(const std::string& path);

/// Returns the path of the JSON file beside the CSV recording `path` that holds its metadata.
std::string recording_info_path(const std::string& path);

}  // namespace tegotae
