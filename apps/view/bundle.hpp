#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tegotae/scene_file/scene_file.hpp"

namespace tegotae::view {

/// One block of bytes for the page: a description in JSON and arrays that it points into. Little-endian: the length of
/// the JSON (32 bits), the JSON padded with blanks to a multiple of 4, then the arrays, 4 bytes a number.
class Bundle {
 public:
  nlohmann::json about;  ///< the description

  /// Appends an array and returns where it is: {at, count}, in numbers from the end of the JSON.
  nlohmann::json add(const std::vector<float>& values);
  nlohmann::json add(const std::vector<std::uint32_t>& values);
  std::string bytes() const;

 private:
  nlohmann::json append(const void* data, std::size_t count);
  std::string arrays_;
};

/// Triangles of all meshes together that a page gets to draw.
inline constexpr std::size_t kMaxTriangles = 300'000;

/// Adds the parts and meshes of a scene: about.parts [{name, mesh, held, pose}], about.meshes [{triangles, shown,
/// positions, indices}] and about.center, the held part's center of mass in its file frame.
void add_scene(Bundle& bundle, const Scene& scene, const Vec3& center);

/// [x, y, z, qw, qx, qy, qz]
nlohmann::json pose_json(const Pose& pose);

/// Adds what the script does: about.script_end (s) and about.goal, the pose of the part that it moves; nothing when it
/// rests.
void add_script(Bundle& bundle, const StylusScript& script);

/// Adds the way of `center` (of mass of the held part, file frame, m) along the poses of a guide: about.guide.
void add_guide(Bundle& bundle, const std::vector<Pose>& path, const Vec3& center);

}  // namespace tegotae::view
