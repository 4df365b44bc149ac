#pragma once

#include <optional>
#include <string>
#include <vector>

#include "review/clearance_band.hpp"
#include "review/path_scan.hpp"
#include "tegotae/scene_file/scene_file.hpp"

namespace tegotae::review {

/// The path as CSV: t, pose of the held part's file frame, clearance and the part it is to, force and torque; a row for
/// each row that was looked at; with a `band` also below, inside or above it.
std::string path_csv(const Scene& scene, const std::vector<RecordFrame>& rows, const Scan& scan,
                     const std::optional<BandFindings>& band);

/// The path as a stylus script (CSV) for the scene's simulated hand: where the hand has to be for its spring to give
/// the forces that the pen met, every 10 ms. `center`: center of mass of the held part, file frame, m.
std::string path_script(const SceneFile& file, const std::vector<RecordFrame>& rows, const Vec3& center);

/// The path as glTF 2.0 (Y up): a node for each part, the held one animated; with a `band` also the way of its center
/// of mass as lines, in the colors of the report: red below the band, yellow inside, blue above. Binary (GLB) when
/// `binary`, else JSON with its data inside. `up`: of the scene, SceneFile::up.
std::string path_gltf(const Scene& scene, UpAxis up, const std::vector<RecordFrame>& rows, const Scan& scan,
                      const std::optional<BandFindings>& band, bool binary);

}  // namespace tegotae::review
