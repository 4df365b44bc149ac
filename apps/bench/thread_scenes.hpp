#pragma once

#include "bench/scenes.hpp"

namespace tegotae::bench {

/// Scenes of nuts and gears, whose pens follow the clock.
const std::vector<std::string>& thread_scene_names();
/// `name` is one of them.
BenchScene make_thread_scene(const std::string& name);

}  // namespace tegotae::bench
