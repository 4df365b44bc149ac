#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tegotae/core/contact_force.hpp"
#include "tegotae/core/export.hpp"
#include "tegotae/core/lag_reason.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// One row of a recording: one certified piece of a tick of the contact loop.
struct RecordFrame {
  std::uint64_t tick = 0;                  ///< number of the contact loop's tick
  std::uint32_t substep = 0;               ///< number of the piece in its tick, from 0
  double t = 0;                            ///< s
  Pose y;                                  ///< where the pen wants the held part's file frame
  Pose x;                                  ///< the held part's file frame, in the world
  Wrench wrench;                           ///< on the pen, at the held part's center of mass, N and N·m
  int contacts = 0;                        ///< TickReport::contacts
  double gap = 0;                          ///< smallest known gap, m; +inf when nothing is near
  double tick_us = 0;                      ///< time that the tick took; 0 in virtual time
  LagReason lag_reason = LagReason::none;  ///< TickReport::lag_reason; none in recordings that do not tell
  ContactForces forces{};                  ///< TickReport::forces, of the tick's end; kept in MCAP only
};

/// What a recording says of itself, so that it can be shown with its parts. Unknown texts are empty.
struct RecordingInfo {
  std::string scene;        ///< path of the scene file, as the recording program saw it or from the recording's folder
  std::string held;         ///< name of the held part
  std::string resolver;     ///< name
  std::string program;      ///< who wrote it, and its version
  std::string suspended{};  ///< names of the parts that the held part overlapped at the start, and was not kept out of
  std::string follows{};    ///< the recording beside it that it goes on from: the scene changed there
  std::string goes_on{};    ///< the recording beside it that goes on from its end: the scene changed there
  std::string guide{};      ///< path of the file whose path the hand was pulled along
  std::string goal{};       ///< where a hand without a script was to bring the held part: X_WF as X,Y,Z,QW,QX,QY,QZ, m
};

/// A recording in memory.
struct Recording {
  RecordingInfo info;               ///< what it is of
  std::vector<RecordFrame> frames;  ///< rows, in the order of the file
  std::string damage;               ///< what is wrong with its end ("the last row is cut"); empty when it is whole
};

/// Reads a recording of Recorder: MCAP when the file begins like one, otherwise CSV, with the columns by name and in
/// any order; more columns and lines that begin with # are skipped. A recording whose end is missing is read up to
/// there. Throws Error `file:line: column: reason` (CSV) or `file: at byte N: reason` (MCAP) for anything else that is
/// wrong.
Recording read_recording(const std::string& path);

/// Where the info of the CSV recording `path` is kept: a JSON file beside it.
std::string recording_info_path(const std::string& path);

}  // namespace tegotae
