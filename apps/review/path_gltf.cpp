#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "review/path_exports.hpp"
#include "tegotae/core/version.hpp"
#include "web/base64.hpp"

namespace tegotae::review {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFloat = 5126, kUnsigned = 5125, kVertices = 34962, kIndices = 34963;
constexpr int kLines = 1;
constexpr std::size_t kMaxKeys = 20000;
// By BandZone, as the report has them (apps/web/src/review/colors.js).
constexpr std::array<std::array<float, 3>, 3> kZoneColors = {{{200 / 255.f, 38 / 255.f, 38 / 255.f},
                                                              {240 / 255.f, 178 / 255.f, 50 / 255.f},
                                                              {44 / 255.f, 123 / 255.f, 182 / 255.f}}};

/// glTF has colors of vertices in linear light.
float linear(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

/// What turns the scene's axis that is up to y, which is up in glTF; x, y, z, w.
Json turned_up(UpAxis up) {
  const double half = std::sqrt(0.5);
  if (up == UpAxis::y) return {0, 0, 0, 1};
  return up == UpAxis::x ? Json{0, 0, half, half} : Json{-half, 0, 0, half};
}

/// Everything of the file but its container.
class Gltf {
 public:
  Gltf(const Scene& scene, UpAxis up, const std::vector<RecordFrame>& rows, const Scan& scan,
       const std::optional<BandFindings>& band) {
    json_["asset"] = {{"version", "2.0"}, {"generator", "tegotae " TEGOTAE_VERSION_STRING}};
    json_["scene"] = 0;
    json_["scenes"] = Json::array({{{"nodes", {0}}}});
    json_["nodes"] = Json::array({{{"name", "world"}, {"rotation", turned_up(up)}}});
    for (const Part& part : scene.parts) add_part(part);
    if (band) add_band(rows, scan, *band);
    animate(rows);
    json_["bufferViews"] = views_;
    json_["accessors"] = accessors_;
  }

  std::string text() {
    json_["buffers"] = Json::array(
        {{{"byteLength", data_.size()}, {"uri", "data:application/octet-stream;base64," + apps::base64(data_)}}});
    return dumped();
  }

  std::string binary() {
    json_["buffers"] = Json::array({{{"byteLength", data_.size()}}});
    std::string text = dumped();
    text.append((4 - text.size() % 4) % 4, ' ');
    std::string out;
    const auto word = [&out](std::size_t value) {
      const auto v = static_cast<std::uint32_t>(value);
      out.append(reinterpret_cast<const char*>(&v), 4);
    };
    out += "glTF";
    word(2);
    word(12 + 8 + text.size() + 8 + data_.size());
    word(text.size());
    out += "JSON" + text;
    word(data_.size());
    out += std::string("BIN\0", 4) + data_;
    return out;
  }

 private:
  // Names come from files and may not be UTF-8.
  std::string dumped() const { return json_.dump(-1, ' ', false, Json::error_handler_t::replace); }

  template <typename Number>
  std::size_t add(const std::vector<Number>& values, const char* type, std::size_t each, int target, bool bounds) {
    Json view = {{"buffer", 0}, {"byteOffset", data_.size()}, {"byteLength", 4 * values.size()}};
    if (target != 0) view["target"] = target;
    views_.push_back(view);
    Json accessor = {{"bufferView", views_.size() - 1},
                     {"componentType", std::is_same_v<Number, float> ? kFloat : kUnsigned},
                     {"count", values.size() / each},
                     {"type", type}};
    if (bounds) {
      std::vector<Number> low(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(each)), high = low;
      for (std::size_t i = 0; i < values.size(); ++i) {
        low[i % each] = std::min(low[i % each], values[i]);
        high[i % each] = std::max(high[i % each], values[i]);
      }
      accessor["min"] = low;
      accessor["max"] = high;
    }
    accessors_.push_back(accessor);
    data_.append(reinterpret_cast<const char*>(values.data()), 4 * values.size());
    return accessors_.size() - 1;
  }

  void add_part(const Part& part) {
    const std::size_t material = materials_++;
    Color color = part.color.value_or(part.held ? Color{0.36f, 0.58f, 0.84f, 1.f} : Color{0.76f, 0.78f, 0.81f, 1.f});
    Json surface = {{"pbrMetallicRoughness",
                     {{"baseColorFactor", {color[0], color[1], color[2], color[3]}},
                      {"metallicFactor", 0},
                      {"roughnessFactor", 0.75}}}};
    if (color[3] < 1) surface["alphaMode"] = "BLEND";
    json_["materials"].push_back(surface);
    auto& accessors = accessors_of_[part.mesh.get()];
    if (accessors.empty()) {
      std::vector<float> positions;
      std::vector<std::uint32_t> indices;
      for (const Vec3& v : part.mesh->vertices)
        for (const double x : v) positions.push_back(static_cast<float>(x));
      for (const auto& t : part.mesh->triangles) indices.insert(indices.end(), t.begin(), t.end());
      accessors = {add(positions, "VEC3", 3, kVertices, true), add(indices, "SCALAR", 1, kIndices, false)};
    }
    json_["meshes"].push_back(
        {{"primitives",
          {{{"attributes", {{"POSITION", accessors[0]}}}, {"indices", accessors[1]}, {"material", material}}}}});
    const Pose& X = part.pose;
    json_["nodes"].push_back({{"name", part.name},
                              {"mesh", json_["meshes"].size() - 1},
                              {"translation", {X.p.x(), X.p.y(), X.p.z()}},
                              {"rotation", {X.q.x(), X.q.y(), X.q.z(), X.q.w()}}});
    json_["nodes"][0]["children"].push_back(json_["nodes"].size() - 1);
    if (part.held) held_ = json_["nodes"].size() - 1;
  }

  /// The way of the center of mass: a line from each row that was looked at to the next, in the color of the first.
  void add_band(const std::vector<RecordFrame>& rows, const Scan& scan, const BandFindings& band) {
    std::vector<float> positions, colors;
    const std::vector<std::size_t> points = looked_at(scan.rows.size(), kMaxKeys);
    for (std::size_t k = 1; k < points.size(); ++k) {
      const auto& color = kZoneColors[static_cast<std::size_t>(band.of_row[points[k - 1]])];
      for (const std::size_t i : {points[k - 1], points[k]}) {
        const Vec3 at = rows[scan.rows[i].row].x * scan.center;
        for (const double x : at) positions.push_back(static_cast<float>(x));
        for (const float c : color) colors.push_back(linear(c));
      }
    }
    if (positions.empty()) return;
    const std::size_t place = add(positions, "VEC3", 3, kVertices, true);
    const std::size_t color = add(colors, "VEC3", 3, kVertices, false);
    json_["meshes"].push_back(
        {{"primitives", {{{"attributes", {{"POSITION", place}, {"COLOR_0", color}}}, {"mode", kLines}}}}});
    json_["nodes"].push_back({{"name", "clearance"}, {"mesh", json_["meshes"].size() - 1}});
    json_["nodes"][0]["children"].push_back(json_["nodes"].size() - 1);
  }

  void animate(const std::vector<RecordFrame>& rows) {
    std::vector<float> times, places, turns;
    Quat last = rows.front().x.q;
    for (const std::size_t i : looked_at(rows.size(), kMaxKeys)) {
      const RecordFrame& row = rows[i];
      const auto t = static_cast<float>(row.t - rows.front().t);
      if (!times.empty() && t <= times.back()) {  // sub-steps of one tick: the last one represents it
        times.pop_back();
        places.resize(places.size() - 3);
        turns.resize(turns.size() - 4);
      }
      Quat q = row.x.q;
      if (q.dot(last) < 0) q.coeffs() *= -1;
      q.normalize();
      last = q;
      times.push_back(t);
      for (const double x : row.x.p) places.push_back(static_cast<float>(x));
      for (const double x : q.coeffs()) turns.push_back(static_cast<float>(x));  // x, y, z, w
    }
    const std::size_t input = add(times, "SCALAR", 1, 0, true);
    const std::size_t place = add(places, "VEC3", 3, 0, false), turn = add(turns, "VEC4", 4, 0, false);
    const auto sampler = [&](std::size_t output) {
      return Json{{"input", input}, {"interpolation", "LINEAR"}, {"output", output}};
    };
    const auto channel = [&](int index, const char* path) {
      return Json{{"sampler", index}, {"target", {{"node", held_}, {"path", path}}}};
    };
    json_["animations"] = Json::array({{{"name", "path"},
                                        {"channels", {channel(0, "translation"), channel(1, "rotation")}},
                                        {"samplers", {sampler(place), sampler(turn)}}}});
  }

  Json json_, views_ = Json::array(), accessors_ = Json::array();
  std::string data_;
  std::map<const TriangleMesh*, std::vector<std::size_t>> accessors_of_;
  std::size_t materials_ = 0, held_ = 0;
};

}  // namespace

std::string path_gltf(const Scene& scene, UpAxis up, const std::vector<RecordFrame>& rows, const Scan& scan,
                      const std::optional<BandFindings>& band, bool binary) {
  Gltf gltf(scene, up, rows, scan, band);
  return binary ? gltf.binary() : gltf.text();
}

}  // namespace tegotae::review
