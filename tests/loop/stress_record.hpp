// Scene file, meshes, pen script and recording of a stress run, for checks by other programs.
#pragma once

#include <fstream>
#include <string>

#include "stress_scenes.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/record/recorder.hpp"

namespace tegotae::test {

class StressRecord {
 public:
  /// Writes NAME_SEED.toml with what it needs and begins NAME_SEED.csv in `folder`, which is made if need be.
  StressRecord(const std::string& folder, const StressScene& scene, unsigned seed);
  void add(int tick, const Pose& Y, const TickReport& report);
  void close();

 private:
  void write_scene(const std::string& folder, const StressScene& scene);

  std::string stem_;
  std::ofstream script_;
  Recorder recorder_;
};

}  // namespace tegotae::test
