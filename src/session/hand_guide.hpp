#pragma once

#include <optional>
#include <string>

#include "coupling/path_guide.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/session/session.hpp"

namespace tegotae {

/// The guide that a run asks for (RunSettings::guide_path), no stronger than the device stands for; none without one.
/// `file` has the bounds of the device. Throws Error for a path that cannot be read, a resolver that draws the part to
/// another place than the load does.
std::optional<PathGuide> make_guide(const SceneFile& file, const RunSettings& settings, const HapticLoop& loop);

/// In one line for people: how it pulls, and how far from its path the part is at `X`.
std::string guide_text(PathGuide guide, const Pose& X);

}  // namespace tegotae
