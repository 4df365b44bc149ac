#include "mesh/file_check.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>

#include "mesh/check_text.hpp"
#include "mesh/gltf_check.hpp"
#include "mesh/off_check.hpp"
#include "mesh/ply_check.hpp"

namespace tegotae {
namespace {

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
