#pragma once

#include <assimp/DefaultIOSystem.h>

#include <filesystem>
#include <string>

namespace tegotae {

/// The files that assimp may open for one mesh file: regular files in its folder and below. A mesh file names others
/// (buffers, materials), and one that names a pipe or a device would never stop being read.
class MeshFolder final : public Assimp::DefaultIOSystem {
 public:
  explicit MeshFolder(const std::string& mesh_file);
  bool Exists(const char* file) const override;
  Assimp::IOStream* Open(const char* file, const char* mode) override;

 private:
  bool allowed(const char* file) const;
  std::filesystem::path folder_;
};

}  // namespace tegotae
