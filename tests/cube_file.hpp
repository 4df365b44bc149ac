#pragma once

#include "apps/run_program.hpp"

namespace tegotae::test {

/// A cube of 10 mm around the origin, as cube.obj in millimeters.
inline void write_cube(const TempFolder& folder) {
  folder.write(
      "cube.obj",
      "v -5 -5 -5\nv 5 -5 -5\nv 5 5 -5\nv -5 5 -5\nv -5 -5 5\nv 5 -5 5\nv 5 5 5\nv -5 5 5\n"
      "f 1 4 3\nf 1 3 2\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n");
}

}  // namespace tegotae::test
