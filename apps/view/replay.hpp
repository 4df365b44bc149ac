#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "tegotae/sim/scene_file.hpp"
#include "view/address.hpp"

namespace tegotae::view {

/// The scene file that a recording (the file at `path`) says it is of: from here, or from the recording's folder.
/// Throws Error when it does not say or there is no such file.
std::string recorded_scene(const std::string& path);

/// The bundle of a recording over its scene, for the page. Contacts are not in a recording: they
/// are found anew, by a contact loop that is led along the recorded poses and a little
/// towards the pen. Long recordings are thinned.
/// Throws Error when the recording cannot be read or the part would stand in another one.
std::string replay_bundle(const std::string& path, SceneFile file);

/// Serves a bundle until `stop`; `announce` gets the address to open. `make_review` makes the HTML report on the
/// recording when the page asks for it, in a thread of the server.
void serve_replay(const std::string& bundle, const std::function<std::string()>& make_review, const Address& address,
                  const std::atomic<bool>& stop, const std::function<void(const std::string&)>& announce);

/// Writes the page with the bundle in it to `path`. Throws Error.
void write_replay(const std::string& bundle, const std::string& path);

}  // namespace tegotae::view
