#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "tegotae/record/recording.hpp"
#include "tegotae/scene_file/scene_file.hpp"
#include "view/address.hpp"

namespace tegotae::view {

class Server;

/// The scene of the recording at `path`, with the part in the hand that was held then: the scene file `scene`, or when
/// that is empty the one that the recording names, from here or from the recording's folder (that of a changed scene:
/// only from there). Throws Error when that does not say or there is no such file.
SceneFile load_recorded_scene(const std::string& path, const RecordingInfo& info, const std::string& scene,
                              SceneOptions how = {});

/// Sentences about the recordings before and after this one, of the same run in other scenes.
std::vector<std::string> scene_changes(const RecordingInfo& info);

/// Frames that a page gets: more than pixels in a plot, and a file of some megabytes.
constexpr std::size_t kMaxFrames = 12'000;

/// The bundle of the recording at `path` over its scene (as load_recorded_scene has it, its meshes read by `load`), for
/// the page. Contacts are not in a recording: they are found anew, by a contact loop that is led along the recorded
/// poses and a little towards the pen. Of a recording of more than `max_frames` rows every second, third … is in it.
/// Throws Error when the recording cannot be read, its scene is not known, the part would stand in another one, or
/// `html`, where the page will be written, is one of the files that are read. Calls `progress` (may be empty) with what
/// is under way, and how many of how many are done (0 of 0: not known), one call at a time.
std::string replay_bundle(
    const std::string& path, const std::string& scene = {}, const std::string& html = {},
    std::size_t max_frames = kMaxFrames,
    const std::function<void(const char* what, std::size_t done, std::size_t total)>& progress = {},
    const MeshLoader& load = load_mesh);

/// Serves a bundle until `stop`; `announce` gets the server, whose address is to be opened. `make_review` makes the
/// HTML report on the recording when the page asks for it, in a thread of the server.
void serve_replay(const std::string& bundle, const std::function<std::string()>& make_review, const Address& address,
                  const std::atomic<bool>& stop, const std::function<void(const Server&)>& announce);

/// Writes the page with the bundle in it to `path`. Throws Error.
void write_replay(const std::string& bundle, const std::string& path);

}  // namespace tegotae::view
