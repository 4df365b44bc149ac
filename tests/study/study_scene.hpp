// Scenes of a few cubes whose answers are known, and how `tegotae study` is run on them.
#pragma once

#include "apps/run_program.hpp"
#include "catch.hpp"
#include "cube_file.hpp"

namespace tegotae::test {

/// A cube of 10 mm, "block", 10 mm over another one, "floor"; both are scene.toml's.
inline void write_blocks(const TempFolder& folder) {
  write_cube(folder);
  folder.write("scene.toml",
               "unit = \"mm\"\n[[part]]\nname = \"floor\"\nmesh = \"cube.obj\"\n"
               "[[part]]\nname = \"block\"\nmesh = \"cube.obj\"\nheld = true\nposition = [0, 0, 0.02]\n");
}

/// The block between five others: open to one side, +y, alone. No other way than that is out.
inline void write_niche(const TempFolder& folder) {
  write_blocks(folder);
  std::string text = "unit = \"mm\"\n[[part]]\nname = \"block\"\nmesh = \"cube.obj\"\nheld = true\n";
  const auto add = [&](const char* name, const char* place) {
    text += std::string("[[part]]\nname = \"") + name + "\"\nmesh = \"cube.obj\"\nposition = [" + place + "]\n";
  };
  add("left", "-0.0101, 0, 0");
  add("right", "0.0101, 0, 0");
  add("below", "0, 0, -0.0101");
  add("above", "0, 0, 0.0101");
  add("back", "0, -0.0101, 0");
  folder.write("niche.toml", text);
}

/// Runs `tegotae study` and checks its exit code.
inline Output run_study(const std::string& arguments, int code = 0) {
  const Output o = run_program("tegotae", "study " + arguments);
  INFO(arguments << "\n" << o.out << o.err);
  CHECK(o.code == code);
  return o;
}

}  // namespace tegotae::test
