#pragma once

#include <string>

#include "apps/run_program.hpp"

namespace tegotae::test {

/// A cube of 10 mm over a floor cube, and a roof beside it.
inline std::string write_cube_scene(const TempFolder& folder) {
  folder.write(
      "cube.obj",
      "v -5 -5 -5\nv 5 -5 -5\nv 5 5 -5\nv -5 5 -5\nv -5 -5 5\nv 5 -5 5\nv 5 5 5\nv -5 5 5\n"
      "f 1 4 3\nf 1 3 2\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n");
  folder.write("scene.toml",
               "unit = \"mm\"\n[[part]]\nname = \"floor\"\nmesh = \"cube.obj\"\n"
               "[[part]]\nname = \"roof\"\nmesh = \"cube.obj\"\nposition = [0.02, 0, 0.04]\n"
               "[[part]]\nname = \"block\"\nmesh = \"cube.obj\"\nheld = true\nposition = [0, 0, 0.03]\n");
  return folder / "scene.toml";
}

}  // namespace tegotae::test
