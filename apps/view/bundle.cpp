#include "view/bundle.hpp"

#include <map>

#include "view/display_mesh.hpp"
#include "view/frame.hpp"

namespace tegotae::view {

using nlohmann::json;

static_assert(sizeof(float) == 4 && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__);

json Bundle::append(const void* data, std::size_t count) {
  const std::size_t at = arrays_.size() / 4;
  arrays_.append(static_cast<const char*>(data), 4 * count);
  return {{"at", at}, {"count", count}};
}

json Bundle::add(const std::vector<float>& values) {
  return append(values.data(), values.size());
}

json Bundle::add(const std::vector<std::uint32_t>& values) {
  return append(values.data(), values.size());
}

std::string Bundle::bytes() const {
  // Names come from files and may not be UTF-8.
  std::string text = about.dump(-1, ' ', false, json::error_handler_t::replace);
  text.append((4 - text.size() % 4) % 4, ' ');
  const auto length = static_cast<std::uint32_t>(text.size());
  std::string out(reinterpret_cast<const char*>(&length), 4);
  return (out += text) += arrays_;
}

json pose_json(const Pose& pose) {
  double values[7];
  store(pose, values);
  return json(values);
}

void add_script(Bundle& bundle, const StylusScript& script) {
  if (!(script.end() > script.begin())) return;
  bundle.about["script_end"] = script.end();
  bundle.about["goal"] = pose_json(script.pose(script.end()));
}

void add_guide(Bundle& bundle, const std::vector<Pose>& path, const Vec3& center) {
  constexpr std::size_t kMaxPoints = 20'000;
  const std::size_t every = path.size() / kMaxPoints + 1;
  std::vector<float> points;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (i % every != 0 && i + 1 < path.size()) continue;
    const Vec3 p = path[i] * center;
    for (int k = 0; k < 3; ++k) points.push_back(static_cast<float>(p[k]));
  }
  bundle.about["guide"] = bundle.add(points);
}

void add_scene(Bundle& bundle, const Scene& scene, const Vec3& center) {
  std::size_t total = 0;
  std::map<const TriangleMesh*, int> numbers;
  for (const Part& part : scene.parts)
    if (numbers.try_emplace(part.mesh.get(), -1).second) total += part.mesh->triangles.size();
  json parts = json::array(), meshes = json::array();
  for (const Part& part : scene.parts) {
    int& number = numbers.at(part.mesh.get());
    if (number < 0) {
      number = static_cast<int>(meshes.size());
      const std::size_t triangles = part.mesh->triangles.size();
      // Each mesh gets its share of what can be shown.
      const std::size_t most = total <= kMaxTriangles ? triangles : kMaxTriangles * triangles / total + 100;
      const DisplayMesh shown = display_mesh(*part.mesh, most);
      meshes.push_back({{"triangles", triangles},
                        {"shown", shown.indices.size() / 3},
                        {"positions", bundle.add(shown.positions)},
                        {"indices", bundle.add(shown.indices)}});
    }
    parts.push_back({{"name", part.name}, {"mesh", number}, {"held", part.held}, {"pose", pose_json(part.pose)}});
    if (!part.path.empty()) parts.back()["path"] = part.path;
    if (part.color) parts.back()["color"] = *part.color;
  }
  bundle.about["parts"] = std::move(parts);
  bundle.about["meshes"] = std::move(meshes);
  bundle.about["center"] = {center.x(), center.y(), center.z()};
}

}  // namespace tegotae::view
