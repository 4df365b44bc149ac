#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tegotae {

/// Takes out of a glTF file what changes neither shape nor place nor the color of a part: textures, cameras, lights,
/// how animations move, attributes like normals, and data that only these name. Whatever is wrong with it is no reason
/// to refuse the file. Indices stay what they are. `notes` gets a line when a color is lost.
void keep_shape(nlohmann::json& top, std::vector<std::string>& notes);

}  // namespace tegotae
