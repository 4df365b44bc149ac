#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "shared/clearance_probe.hpp"
#include "tegotae/loop/initial_contacts.hpp"
#include "tegotae/loop/scene.hpp"
#include "tegotae/record/recording.hpp"
#include "tegotae/session/session.hpp"

namespace tegotae::review {

using apps::Clearance;
using apps::ClearanceProbe;

/// Tells how far something has come.
using Progress = std::function<void(const char* what, std::size_t done, std::size_t total)>;

/// The rows of a recording at which poses are looked at: all, or of more than `most` every second, third ... one, and
/// always the first and the last.
std::vector<std::size_t> looked_at(std::size_t rows, std::size_t most);

/// What is known of a row that is looked at.
struct ScannedRow {
  std::size_t row = 0;                ///< of the recording
  std::vector<Clearance> clearances;  ///< of the nearest part, then of those within reach
  double contact_gap = 0;             ///< nearer parts are in contact, m
  bool two_sided = false;             ///< contacts hold the part from two sides: no translation leaves them all
  Vec3 contact_W = Vec3::Zero();      ///< middle of the contacts, where `two_sided`
};

struct Scan {
  std::vector<ScannedRow> rows;
  std::size_t every = 1;       ///< of the recording's rows, every so many-th
  double reach = 0;            ///< m; distances to parts that are not the nearest are known below it
  std::size_t astray = 0;      ///< rows at which contacts could not be found
  Vec3 center;                 ///< of mass of the held part, m, file frame
  CouplingSettings coupling;   ///< of the contact loop: what the held part was felt with
  InitialContactReport start;  ///< of the contact loop, before the first row
  HeldFast held_fast;          ///< as RunSummary::held_fast
};

/// Looks at the poses of a recording: distances by the parts' triangles, contacts by a contact loop led along the
/// poses. `scene` holds the part where the run began. `file` is the name of the recording, for messages; `reach` (m):
/// Scan::reach is at least that. Works on all processors; the result does not depend on their number. Throws Error when
/// it does not fit the scene.
Scan scan_path(const Scene& scene, const std::string& file, const std::vector<RecordFrame>& rows,
               const Progress& progress, double reach = 0);

/// Whether no translation leaves all contacts with these normals (unit, from the others to the held part): the origin
/// is in the convex hull of the normals, or nearer to it than a wedge of 10 degrees would be.
bool holds_from_two_sides(const std::vector<Vec3>& normals);

}  // namespace tegotae::review
