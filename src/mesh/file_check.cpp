#include "mesh/file_check.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <type_traits>

#include "mesh/gltf_check.hpp"
#include "mesh/ply_check.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

constexpr std::string_view kBlank = " \t\r\n";

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw Error(path + ": " + why);
}

std::uint32_t little_endian_32(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
  return value;
}

void check_stl(const std::string& path, std::string_view bytes) {
  constexpr std::size_t kHeader = 84, kFacet = 50;
  const std::uint64_t facets = bytes.size() < kHeader ? 0 : little_endian_32(bytes, kHeader - 4);
  if (bytes.size() >= kHeader && kHeader + kFacet * facets == bytes.size()) return;  // binary
  const std::size_t start = std::min(bytes.find_first_not_of(kBlank), bytes.size());
  if (bytes.substr(start, 5) == "solid") {
    const std::size_t end = bytes.rfind("endsolid");
    if (end == std::string_view::npos || bytes.find("facet", end) != std::string_view::npos) {
      refuse(path, "truncated: the last solid has no endsolid");
    }
    return;
  }
  if (bytes.size() < kHeader) refuse(path, "truncated: too short for a binary STL and no text STL");
  refuse(path, (kHeader + kFacet * facets > bytes.size() ? "truncated: " : "damaged: ") + std::to_string(facets) +
                   " triangles are announced, the file has room for " +
                   std::to_string((bytes.size() - kHeader) / kFacet));
}

/// An OBJ file that stops in the middle of a line: assimp takes a face of two corners for a line, and drops it.
void check_obj(const std::string& path, std::string_view bytes) {
  if (bytes.empty() || bytes.back() == '\n' || bytes.back() == '\r') return;
  const std::string_view line = bytes.substr(bytes.find_last_of("\r\n") + 1);
  if (line.substr(0, 2) != "f " && line.substr(0, 2) != "v ") return;
  std::size_t words = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    words += std::isspace(static_cast<unsigned char>(line[i])) == 0 && (i == 0 || std::isspace(line[i - 1]) != 0);
  }
  if (words < 4) refuse(path, "truncated: the last line is \"" + std::string(line) + '"');
}

/// An OFF file as assimp reads it: the header by words, with comments from # to the end of the line, then a vertex or
/// face to a line.
class OffText {
 public:
  explicit OffText(std::string_view bytes) : bytes_(bytes) {}

  std::string_view header_word() {
    skip_comments();
    const std::size_t begin = at_;
    at_ = std::min(bytes_.find_first_of(kBlank, at_), bytes_.size());
    return bytes_.substr(begin, at_ - begin);
  }
  /// The next line that is not empty; without more lines, an empty one.
  std::string_view line() {
    at_ = std::min(bytes_.find_first_not_of("\r\n", at_), bytes_.size());
    const std::size_t begin = at_;
    at_ = std::min(bytes_.find_first_of("\r\n", at_), bytes_.size());
    return bytes_.substr(begin, at_ - begin);
  }
  void skip_comments() {
    while ((at_ = std::min(bytes_.find_first_not_of(kBlank, at_), bytes_.size())) < bytes_.size() && bytes_[at_] == '#')
      at_ = std::min(bytes_.find_first_of("\r\n", at_), bytes_.size());
  }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

/// Takes the first word of a line as a number.
template <class T>
bool take_number(std::string_view& line, T& value) {
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBlank));
  line.remove_prefix(word.size());
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  // A number too large for a double is a number; the coordinates are judged after loading.
  const bool number = error == std::errc() || (std::is_floating_point_v<T> && error == std::errc::result_out_of_range);
  return number && end == word.data() + word.size();
}

void check_off_face(const std::string& path, std::string_view line, std::int64_t face, std::int64_t vertices) {
  constexpr std::int64_t kMostCorners = 9;  // assimp drops larger faces without a word
  const std::string name = "face " + std::to_string(face);
  std::int64_t corners = 0;
  // assimp reads on past a face without corners and ends in a segmentation fault.
  if (!take_number(line, corners) || corners < 1) refuse(path, "truncated or damaged at " + name);
  if (corners > kMostCorners) {
    refuse(path, name + " has " + std::to_string(corners) + " corners; faces of OFF files are read up to " +
                     std::to_string(kMostCorners) + ": export the part as triangles");
  }
  for (std::int64_t k = 0; k < corners; ++k) {
    std::int64_t index = 0;
    if (!take_number(line, index)) refuse(path, "truncated or damaged in " + name + ", which takes a line");
    if (index < 0 || index >= vertices) {
      refuse(path, "index out of range: " + name + " names vertex " + std::to_string(index) + " of " +
                       std::to_string(vertices));
    }
  }
}

void check_off(const std::string& path, std::string_view bytes) {
  constexpr std::size_t kLongestLine = 4000;  // assimp's buffer for a line has 4096 bytes, and it does not mind its end
  OffText text(bytes);
  const std::string_view magic = text.header_word();
  if (magic.size() < 3 || magic.substr(magic.size() - 3) != "OFF") refuse(path, "damaged: it does not begin with OFF");
  const auto control = [](char c) { return static_cast<unsigned char>(c) < 32 && kBlank.find(c) == kBlank.npos; };
  if (std::any_of(bytes.begin(), bytes.end(), control))
    refuse(path, "damaged: it has control characters (text OFF only)");
  std::array<std::int64_t, 3> counts{};  // of vertices, faces, edges
  for (std::int64_t& count : counts) {
    std::string_view word = text.header_word();
    if (!take_number(word, count) || count < 0) {
      refuse(path, "damaged: the counts of vertices, faces and edges are no numbers (text OFF only)");
    }
  }
  const auto [vertices, faces, edges] = counts;
  const auto room = static_cast<std::int64_t>(bytes.size());
  if (vertices > room || faces > room) refuse(path, "truncated: it announces more elements than it has bytes");
  text.skip_comments();
  for (std::int64_t i = 0; i < vertices + faces; ++i) {
    std::string_view line = text.line();
    if (line.size() > kLongestLine) refuse(path, "damaged: a line is longer than 4000 characters");
    if (i >= vertices) {
      check_off_face(path, line, i - vertices, vertices);
      continue;
    }
    for (int k = 0; k < 3; ++k) {
      double x = 0;
      if (!take_number(line, x)) {
        refuse(path, "truncated or damaged at vertex " + std::to_string(i) + ", which takes a line of its own");
      }
    }
  }
}

}  // namespace

std::string read_bytes(const std::string& path) {
  std::error_code status;
  if (std::filesystem::exists(path, status) && !std::filesystem::is_regular_file(path, status)) {
    refuse(path, "is not a regular file");  // a device or pipe might have no end
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse(path, std::string("cannot be read: ") + std::strerror(errno));
  std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (file.bad()) refuse(path, "cannot be read to its end");
  return bytes;
}

std::string lower_extension(const std::string& path) {
  std::string e = std::filesystem::path(path).extension().string();
  std::transform(e.begin(), e.end(), e.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return e;
}

void check_mesh_file(const std::string& path) {
  const std::string bytes = read_bytes(path);
  if (bytes.find_first_not_of(kBlank) == std::string::npos) refuse(path, "empty file");
  const std::string extension = lower_extension(path);
  const std::string_view start = std::string_view(bytes).substr(bytes.find_first_not_of(kBlank));
  if (start.substr(0, 12) == "ISO-10303-21" || extension == ".step" || extension == ".stp") {
    refuse(path, "a STEP file has no triangles: turn it into a scene first (tegotae import FILE -o DIR)");
  }
  if (extension == ".stl") {
    check_stl(path, bytes);
  } else if (extension == ".obj") {
    check_obj(path, bytes);
  } else if (extension == ".off") {
    check_off(path, bytes);
  } else if (extension == ".ply") {
    check_ply(path, bytes);
  } else if (extension == ".glb" || extension == ".gltf") {
    check_gltf(path, bytes);
  } else {
    refuse(path, "unknown format \"" + extension + "\" (known: stl, obj, ply, off, gltf, glb)");
  }
}

}  // namespace tegotae
