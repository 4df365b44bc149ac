#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plan/disassembly.hpp"
#include "review/clearance_band.hpp"
#include "tegotae/scene_file/scene_file.hpp"

namespace tegotae::plan {

/// The files that write_order() may make or remove in `folder` for an assembly of so many parts.
std::vector<std::string> order_files(const std::string& folder, std::size_t parts);

/// Writes order.csv, order.dot (for Graphviz), order.html and, for each step, step-NN.csv (poses) and step-NN.glb into
/// `folder`; with a `band` the steps' files tell and show where they are to it. Steps of an earlier order that are more
/// are removed. Throws Error.
void write_order(const SceneFile& file, const Disassembly& order, const std::optional<review::ClearanceBand>& band,
                 const std::string& folder, const review::Progress& progress);

/// What came out, for a person.
std::string order_text(const Scene& scene, const Disassembly& order);

}  // namespace tegotae::plan
