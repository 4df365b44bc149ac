#include "import/load_cached.hpp"

#include <assimp/version.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <string_view>
#include <vector>

#include "core/file_descriptor.hpp"
#include "import/file_check.hpp"
#include "mesh/cache_entry.hpp"

namespace tegotae {
namespace {

// To be raised whenever load_mesh() makes another mesh, or other notes, of the same file.
constexpr std::uint32_t kBuild = 2;
constexpr std::size_t kPiece = std::size_t{1} << 18;
// The key of a name in glTF, and what each other way to write it has.
constexpr std::string_view kUri = "\"uri\"", kEscape = "\\u";

/// Whether meshes of this kind of file may be made of other files too.
bool may_name_others(const std::string& extension) {
  return extension == ".gltf" || extension == ".glb";
}

void add_text(ContentSum& sum, const std::string& text) {
  const std::uint64_t size = text.size();
  sum.add(&size, sizeof size);
  sum.add(text.data(), text.size());
}

/// Of all that a mesh is made of. None: the file cannot be read (whoever reads it will say why) or names others.
std::optional<ContentKey> key_of_file(const std::string& path, double unit_in_m) {
  const FileDescriptor file(above_standard(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)));
  struct stat status;
  if (file.get() < 0 || fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  ContentSum sum;
  const std::string extension = lower_extension(path);
  const bool others = may_name_others(extension);
  add_text(sum, extension);
  sum.add(&unit_in_m, sizeof unit_in_m);
  for (const unsigned version : {aiGetVersionMajor(), aiGetVersionMinor(), aiGetVersionPatch()})
    sum.add(&version, sizeof version);
  std::string piece;
  std::size_t kept = 0;  // the end of the piece before, in which a name may begin
  for (;;) {
    piece.resize(kept + kPiece);
    const ssize_t n = ::read(file.get(), piece.data() + kept, kPiece);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return std::nullopt;
    if (n == 0) return sum.key();
    sum.add(piece.data() + kept, static_cast<std::size_t>(n));
    if (!others) continue;
    piece.resize(kept + static_cast<std::size_t>(n));
    if (piece.find(kUri) != piece.npos || piece.find(kEscape) != piece.npos) return std::nullopt;
    kept = std::min(piece.size(), kUri.size() - 1);
    piece.erase(0, piece.size() - kept);
  }
}

bool is_sound(const TriangleMesh& mesh) {
  const std::size_t n = mesh.vertices.size();
  return !mesh.triangles.empty() && std::all_of(mesh.triangles.begin(), mesh.triangles.end(),
                                                [n](const auto& t) { return t[0] < n && t[1] < n && t[2] < n; });
}

bool take(const CacheName& name, TriangleMesh& mesh) {
  CacheReader entry(name);
  std::vector<char> notes;
  if (!entry.take(notes) || !entry.take(mesh.vertices) || !entry.take(mesh.triangles) || !entry.done() ||
      !is_sound(mesh))
    return false;
  for (auto begin = notes.begin(); begin != notes.end();) {
    const auto end = std::find(begin, notes.end(), '\0');
    mesh.notes.emplace_back(begin, end);
    begin = end == notes.end() ? end : end + 1;
  }
  return true;
}

void keep(const CacheName& name, const TriangleMesh& mesh) {
  std::vector<char> notes;
  for (const std::string& note : mesh.notes) notes.insert(notes.end(), note.c_str(), note.c_str() + note.size() + 1);
  CacheWriter entry(name);
  entry.put(notes);
  entry.put(mesh.vertices);
  entry.put(mesh.triangles);
  entry.keep();
}

}  // namespace

TriangleMesh load_cached(const std::string& path, double unit_in_m, const std::function<TriangleMesh()>& read) {
  if (!has_cache_folder()) return read();
  const std::optional<ContentKey> key = key_of_file(path, unit_in_m);
  if (!key) return read();
  const CacheName name{"mesh", kBuild, *key};
  TriangleMesh kept;
  kept.name = path;
  if (take(name, kept)) return kept;
  TriangleMesh mesh = read();
  // Not when the file was written to meanwhile.
  if (mesh.triangles.size() >= kMinCached && key_of_file(path, unit_in_m) == key) keep(name, mesh);
  return mesh;
}

}  // namespace tegotae
