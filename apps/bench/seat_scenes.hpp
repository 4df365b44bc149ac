#pragma once

#include <string>
#include <vector>

#include "bench/scenes.hpp"

namespace tegotae::bench {

/// Scenes of parts that mate over an area.
const std::vector<std::string>& seat_scene_names();

/// `name` is one of the names.
BenchScene make_seat_scene(const std::string& name);

}  // namespace tegotae::bench
