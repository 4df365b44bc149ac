#pragma once

#include <string>

#include "apps/run_program.hpp"
#include "cube_file.hpp"

namespace tegotae::test {

/// A cube of 10 mm over a floor cube, and a roof beside it.
inline std::string write_cube_scene(const TempFolder& folder) {
  write_cube(folder);
  folder.write("scene.toml",
               "unit = \"mm\"\n[[part]]\nname = \"floor\"\nmesh = \"cube.obj\"\n"
               "[[part]]\nname = \"roof\"\nmesh = \"cube.obj\"\nposition = [0.02, 0, 0.04]\n"
               "[[part]]\nname = \"block\"\nmesh = \"cube.obj\"\nheld = true\nposition = [0, 0, 0.03]\n");
  return folder / "scene.toml";
}

}  // namespace tegotae::test
