#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "view/address.hpp"

namespace tegotae::view {

/// The bundle of the recording at `path` over its scene, for the page, with the part in the hand that was held then.
/// `scene`: the scene file; empty: the one that the recording names, from here or from the recording's folder. Contacts
/// are not in a recording: they are found anew, by a contact loop that is led along the recorded poses and a little
/// towards the pen. Long recordings are thinned.
/// Throws Error when the recording cannot be read, its scene is not known, or the part would stand in another one.
std::string replay_bundle(const std::string& path, const std::string& scene = {});

/// Serves a bundle until `stop`; `announce` gets the address to open.
void serve_replay(const std::string& bundle, const Address& address, const std::atomic<bool>& stop,
                  const std::function<void(const std::string&)>& announce);

/// Writes the page with the bundle in it to `path`. Throws Error.
void write_replay(const std::string& bundle, const std::string& path);

}  // namespace tegotae::view
