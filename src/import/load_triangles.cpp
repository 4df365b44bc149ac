#include "import/load_triangles.hpp"

#include <assimp/fast_atof.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

template <typename T>
T value_at(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// Three corners of its own for each triangle.
void add_triangle(const std::array<Vec3, 3>& corners, TriangleMesh& mesh) {
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
  mesh.triangles.push_back({n, n + 1, n + 2});
}

std::optional<TriangleMesh> of_stl(std::string_view bytes) {
  constexpr std::size_t kHeader = 84, kFacet = 50, kNormal = 12, kCorner = 12;
  if (bytes.size() < kHeader) return std::nullopt;
  const std::size_t facets = value_at<std::uint32_t>(bytes, kHeader - 4);
  if (facets == 0 || bytes.size() != kHeader + kFacet * facets) return std::nullopt;  // text, or nothing
  TriangleMesh mesh;
  mesh.vertices.reserve(3 * facets);
  mesh.triangles.reserve(facets);
  for (std::size_t f = 0; f < facets; ++f) {
    std::array<Vec3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < 3; ++i)
        corners[k][static_cast<Eigen::Index>(i)] =
            double{value_at<float>(bytes, kHeader + kFacet * f + kNormal + kCorner * k + 4 * i)};
    add_triangle(corners, mesh);
  }
  return mesh;
}

/// The number behind `word` in the header of a file as PlyBytes writes it.
std::size_t count_of(std::string_view header, std::string_view word) {
  std::size_t count = 0;
  header.remove_prefix(header.find(word) + word.size());
  std::from_chars(header.data(), header.data() + header.size(), count);
  return count;
}

std::optional<TriangleMesh> of_ply(std::string_view bytes) {
  constexpr std::string_view kEnd = "end_header\n";
  const std::size_t begin = bytes.find(kEnd) + kEnd.size();
  const std::string_view header = bytes.substr(0, begin);
  const std::size_t vertices = count_of(header, "element vertex "), faces = count_of(header, "element face ");
  bytes.remove_prefix(begin);
  TriangleMesh mesh;
  mesh.vertices.reserve(vertices);
  for (std::size_t v = 0; v < vertices; ++v, bytes.remove_prefix(3 * sizeof(double))) {
    Vec3 p;
    for (std::size_t i = 0; i < 3; ++i)
      p[static_cast<Eigen::Index>(i)] = double{static_cast<float>(value_at<double>(bytes, i * sizeof(double)))};
    mesh.vertices.push_back(p);
  }
  mesh.triangles.reserve(faces);
  for (std::size_t f = 0; f < faces; ++f) {
    const std::size_t corners = value_at<std::uint32_t>(bytes, 0);
    if (corners > 3) return std::nullopt;
    if (corners == 3)
      mesh.triangles.push_back(
          {value_at<std::uint32_t>(bytes, 4), value_at<std::uint32_t>(bytes, 8), value_at<std::uint32_t>(bytes, 12)});
    bytes.remove_prefix(4 + 4 * corners);
  }
  return mesh;
}

/// What assimp's number reader throws; the words were checked before.
struct NoNumber : Error {
  template <class... Words>
  explicit NoNumber(const Words&...) : Error("a coordinate is not a number") {}
};

/// Lines of "v x y z" and "f a b c" as plain_obj writes them, with one space between words.
class PlainObj {
 public:
  explicit PlainObj(const std::string& text) : rest_(text) {}

  std::optional<TriangleMesh> read() {
    while (!rest_.empty()) {
      line_ = rest_.substr(0, rest_.find('\n'));
      rest_.remove_prefix(line_.size() + 1);
      const std::string_view word = take_word();
      if (word == "v")
        read_vertex();
      else if (word == "f" ? !read_face() : word != "mtllib" && !begins(word))
        return std::nullopt;
    }
    return std::move(mesh_);
  }

 private:
  std::string_view take_word() {
    const std::string_view word = line_.substr(0, line_.find(' '));
    line_.remove_prefix(std::min(word.size() + 1, line_.size()));
    return word;
  }

  void read_vertex() {
    Vec3 p;
    for (double& x : p) {
      float value = 0;
      Assimp::fast_atoreal_move<float, NoNumber>(std::string(take_word()).c_str(), value);
      x = double{value};
    }
    known_.push_back(p);
  }

  bool read_face() {
    std::array<Vec3, 3> corners;
    for (Vec3& corner : corners) {
      const std::string_view word = take_word();
      std::size_t index = 0;
      std::from_chars(word.data(), word.data() + word.size(), index);
      if (index > known_.size()) return false;  // of a vertex behind it
      corner = known_[index - 1];
    }
    if (!line_.empty()) return false;
    add_triangle(corners, mesh_);
    return true;
  }

  /// Whether a name, of an object, a group or a material, is the first of its kind, before all faces. assimp puts
  /// together what has one name, and keeps apart what has two.
  bool begins(std::string_view word) {
    if (!mesh_.triangles.empty() || std::find(seen_.begin(), seen_.end(), word) != seen_.end()) return false;
    seen_.push_back(word);
    return true;
  }

  std::string_view rest_, line_;
  std::vector<Vec3> known_;
  std::vector<std::string_view> seen_;
  TriangleMesh mesh_;
};

}  // namespace

std::optional<TriangleMesh> triangles_of(const PlainMesh& plain) {
  if (plain.format == "stl") return of_stl(plain.bytes);
  if (plain.format == "ply") return of_ply(plain.bytes);
  return PlainObj(plain.bytes).read();
}

}  // namespace tegotae
