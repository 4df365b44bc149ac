#include "import/load_files.hpp"

#include <assimp/MemoryIOWrapper.h>

#include <algorithm>
#include <cstdint>
#include <system_error>

namespace tegotae {

namespace fs = std::filesystem;

MeshFolder::MeshFolder(const std::string& mesh_file, std::string_view bytes, bool others)
    : mesh_file_(mesh_file), bytes_(bytes), others_(others) {
  // The mesh file itself may be a link to somewhere else; what it names lies beside it as it was named.
  std::error_code none;
  folder_ = fs::canonical(fs::absolute(mesh_file, none).parent_path(), none);
}

bool MeshFolder::allowed(const char* file) const {
  if (!others_ && file != mesh_file_) return false;
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return false;
  const fs::path parent = fs::canonical(fs::absolute(file, error).parent_path(), error);
  return !error && std::mismatch(folder_.begin(), folder_.end(), parent.begin(), parent.end()).first == folder_.end();
}

bool MeshFolder::Exists(const char* file) const {
  return allowed(file) && DefaultIOSystem::Exists(file);
}

Assimp::IOStream* MeshFolder::Open(const char* file, const char* mode) {
  if (!allowed(file)) return nullptr;
  if (!bytes_.empty() && file == mesh_file_)
    return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes_.data()), bytes_.size());
  return DefaultIOSystem::Open(file, mode);
}

}  // namespace tegotae
