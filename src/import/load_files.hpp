#pragma once

#include <assimp/DefaultIOSystem.h>

#include <filesystem>
#include <string>
#include <string_view>

namespace tegotae {

/// The files that assimp may open for one mesh file: regular files in its folder and below. A mesh file names others
/// (buffers, materials), and one that names a pipe or a device would never stop being read. In the place of the mesh
/// file itself `bytes` are read, when there are any; they must outlive this. Without `others` there is no other file.
class MeshFolder final : public Assimp::DefaultIOSystem {
 public:
  explicit MeshFolder(const std::string& mesh_file, std::string_view bytes = {}, bool others = true);
  bool Exists(const char* file) const override;
  Assimp::IOStream* Open(const char* file, const char* mode) override;

 private:
  bool allowed(const char* file) const;
  const std::string mesh_file_;
  const std::string_view bytes_;
  const bool others_;
  std::filesystem::path folder_;
};

}  // namespace tegotae
