// The scenes of the stress runs: generated bodies, and real parts where they are there.
#pragma once

#include <string>
#include <vector>

#include "stress_script.hpp"
#include "tegotae/loop/scene.hpp"

namespace tegotae::test {

struct StressScene {
  std::string name;
  Scene scene;
  Envelope envelope;
  /// Mesh file and unit of each part, as a scene file names them; empty file: generated.
  struct Source {
    std::string file, unit;
  };
  std::vector<Source> sources;
};

/// Names of all scenes that can be made here; says on standard output which are skipped for want of files.
std::vector<std::string> stress_scene_names();
/// The scene `name`; `seed` chooses among its starts, and its bodies where they are random. Throws Error when unknown.
StressScene stress_scene(const std::string& name, unsigned seed);

}  // namespace tegotae::test
