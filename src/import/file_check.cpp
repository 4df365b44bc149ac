#include "import/file_check.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "import/check_text.hpp"
#include "import/plain_obj.hpp"
#include "import/plain_off.hpp"
#include "import/plain_ply.hpp"
#include "import/plain_stl.hpp"

namespace tegotae {
std::string read_bytes(const std::string& path) {
  std::error_code status;
  if (!std::filesystem::exists(path, status)) refuse(path, "no such file");
  // A device or pipe might have no end.
  if (!std::filesystem::is_regular_file(path, status)) refuse(path, "is not a regular file");
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse(path, std::string("cannot be read: ") + std::strerror(errno));
  // By its length, and then what a file without one has.
  const std::uintmax_t length = std::filesystem::file_size(path, status);
  std::string bytes(status ? 0 : static_cast<std::size_t>(length), '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  bytes.append(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  if (file.bad()) refuse(path, "cannot be read to its end");
  return bytes;
}

void require_file(const std::string& path) {
  std::error_code status;
  const bool there = std::filesystem::exists(path, status);
  if (there && std::filesystem::is_regular_file(path, status)) return;
  throw Error(ErrorKind::file, path + (there ? ": not a file" : ": no such file"), {path, 0, {}, {}});
}

std::string lower_extension(const std::string& path) {
  std::string e = std::filesystem::path(path).extension().string();
  std::transform(e.begin(), e.end(), e.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return e;
}

bool is_file_of_parts(const std::string& path) {
  static constexpr std::array<const char*, 9> kEndings = {".stl", ".obj", ".ply", ".off", ".gltf",
                                                          ".glb", ".3mf", ".stp", ".step"};
  const std::string ending = lower_extension(path);
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

std::string read_mesh_bytes(const std::string& path) {
  std::string bytes = read_bytes(path);
  const std::size_t start = bytes.find_first_not_of(kBlank);
  if (start == std::string::npos) refuse(path, "empty file");
  const std::string extension = lower_extension(path);
  if (bytes.compare(start, 12, "ISO-10303-21") == 0 || extension == ".step" || extension == ".stp") {
    refuse(path, "a STEP file has no triangles: turn it into a scene first (tegotae import FILE -o DIR)");
  }
  return bytes;
}

PlainMesh plain_mesh(const std::string& path) {
  std::string bytes = read_mesh_bytes(path);
  const std::string extension = lower_extension(path);
  if (extension == ".stl") return {plain_stl(path, std::move(bytes)), "stl", {}};
  PlainMesh mesh{{}, extension == ".obj" ? "obj" : "ply", {}};
  if (extension == ".ply")
    mesh.bytes = plain_ply(path, bytes, mesh.notes);
  else if (extension == ".off")
    mesh.bytes = plain_off(path, bytes, mesh.notes);
  else if (extension == ".obj")
    mesh.bytes = plain_obj(path, bytes, mesh.notes);
  else if (extension == ".toml")
    refuse(path, "a scene file, where a part is wanted");
  else
    refuse(path, "unknown format \"" + extension + "\" (known: stl, obj, ply, off, gltf, glb, 3mf; step for import)");
  return mesh;
}

}  // namespace tegotae
