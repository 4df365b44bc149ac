#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "scene_file/toml_table.hpp"
#include "tegotae/scene_file/scene_file.hpp"

namespace tegotae {

/// The mesh files that a scene names, each read once, several at the same time.
class MeshFiles {
 public:
  /// Part number `part`, of table `t`, has the mesh of this file and unit (m).
  void add(std::size_t part, const TomlTable& t, const std::string& file, double unit_in_m);
  /// Reads them and gives the parts their meshes. Of several that cannot be read the Error is that of the first one.
  void read(const SceneOptions& options, std::vector<Part>& parts) const;

 private:
  struct File {
    std::string path;
    double unit_in_m;
    TomlTable named_by;  ///< the first table that names it
    std::vector<std::size_t> parts;
  };
  std::vector<File> files_;
  std::map<std::pair<std::string, double>, std::size_t> place_;
};

}  // namespace tegotae
