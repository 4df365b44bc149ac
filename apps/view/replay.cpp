#include "view/replay.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/output_file.hpp"
#include "core/same_file.hpp"
#include "loop/mesh_structures.hpp"
#include "loop/scene_parts.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/scene_file/scene_file.hpp"
#include "view/bundle.hpp"
#include "view/follower.hpp"
#include "view/frame_maker.hpp"
#include "view/server.hpp"
#include "view/wire.hpp"
#include "web/page.hpp"

namespace tegotae::view {
namespace {

constexpr auto kReplayPoll = std::chrono::milliseconds(50);

/// The frame of a row: recorded values, with the contacts found.
void fill(const RecordFrame& row, const Follower& follower, const FrameMaker& maker, Frame& frame) {
  maker.add_loop(follower.loop(), frame);
  if (follower.astray()) frame.pair_count = 0;
  store(row.forces, frame);
  frame.tick = row.tick;
  frame.t = row.t;
  store(row.x, frame.x);
  store(row.y, frame.y);
  store(row.wrench, frame.wrench);
  frame.gap = row.gap;
  frame.tick_us = row.tick_us;
  frame.servo_late_us = std::numeric_limits<double>::quiet_NaN();
  frame.contacts = static_cast<std::uint32_t>(row.contacts);
  frame.flags = (row.contacts > 0 ? Frame::touching : 0u) | static_cast<std::uint32_t>(row.lag_reason)
                                                                << Frame::kLagShift;
}

/// All in the bundle, and a review that is made when it is first asked for.
class ReplaySource final : public ViewSource {
 public:
  ReplaySource(std::string bundle, std::function<std::string()> make_review)
      : bundle_(std::make_shared<const std::string>(std::move(bundle))), make_review_(std::move(make_review)) {}
  std::shared_ptr<const std::string> scene() const override { return bundle_; }
  const FrameRing* frames() const override { return nullptr; }
  std::string status() const override { return "{}"; }
  void command(const nlohmann::json&) override { throw Error("a recording takes no commands"); }
  std::string review(const std::string&) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (review_.empty()) review_ = make_review_();
    return review_;
  }

 private:
  std::shared_ptr<const std::string> bundle_;
  std::function<std::string()> make_review_;
  std::mutex mutex_;
  std::string review_;
};

/// Called with what is done now, and how far it is.
using Progress = std::function<void(const char* what, std::size_t done, std::size_t total)>;

/// The pictures of a recording, one after the other, as the page reads them.
struct Frames {
  std::vector<float> frames, pairs, forces;
  std::vector<std::uint32_t> pair_begin, force_begin;
};

/// A frame of each row that is a multiple of `every`, and of the last one.
Frames frames_of(const std::vector<RecordFrame>& rows, std::size_t every, Follower& follower, const Progress& tell) {
  Frames out;
  const FrameMaker maker;
  Frame frame;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    tell("finding contacts, row", i, rows.size());
    follower.step(rows[i]);
    if (i % every != 0 && i + 1 < rows.size()) continue;
    fill(rows[i], follower, maker, frame);
    append_frame(frame, out.frames);
    out.pair_begin.push_back(static_cast<std::uint32_t>(out.pairs.size() / kPairFloats));
    append_pairs(frame, out.pairs);
    out.force_begin.push_back(static_cast<std::uint32_t>(out.forces.size() / kForceFloats));
    append_forces(frame, out.forces);
  }
  return out;
}

/// What whoever looks at a replay should know about it.
nlohmann::json notes_of(const Recording& recording, std::size_t every, bool has_forces) {
  const std::vector<RecordFrame>& rows = recording.frames;
  nlohmann::json notes = nlohmann::json::array({"Contacts recomputed from the recorded poses"});
  const bool felt = std::any_of(rows.begin(), rows.end(), [](const auto& row) { return row.contacts > 0; });
  if (felt && !has_forces) notes.push_back("Contact forces are not in this recording (MCAP has those of qp)");
  if (every > 1) notes.push_back("Every " + std::to_string(every) + "th of " + std::to_string(rows.size()) + " rows");
  if (!recording.damage.empty()) notes.push_back("The end is missing: " + recording.damage);
  for (const std::string& note : scene_changes(recording.info)) notes.push_back(note);
  if (!recording.info.filtered.empty()) notes.push_back("Suspended at the start: " + recording.info.filtered);
  return notes;
}

std::string named_scene(const std::string& path, const RecordingInfo& info) {
  const std::string& scene = info.scene;
  if (scene.empty()) throw Error(path + ": does not name its scene; add the scene file to the command");
  const std::filesystem::path beside = std::filesystem::path(path).parent_path() / scene;
  // That of a changed scene was written there.
  const std::filesystem::path named = info.continues.empty() ? std::filesystem::path(scene) : beside;
  for (const std::filesystem::path& file : {named, beside})
    if (std::filesystem::exists(file)) return file.string();
  throw Error(path + ": its scene " + scene + " is gone; add the scene file to the command");
}

}  // namespace

SceneFile load_recorded_scene(const std::string& path, const RecordingInfo& info, const std::string& scene,
                              SceneOptions how) {
  how.hold = info.held;
  return load_scene(scene.empty() ? named_scene(path, info) : scene, how);
}

std::vector<std::string> scene_changes(const RecordingInfo& info) {
  std::vector<std::string> texts;
  if (!info.continues.empty()) texts.push_back("It continues " + info.continues + ", where the scene changed.");
  if (!info.continued_by.empty())
    texts.push_back("At its end the scene changed; the run continues in " + info.continued_by + ".");
  return texts;
}

std::string replay_bundle(const std::string& path, const std::string& scene, const std::string& html,
                          std::size_t max_frames,
                          const std::function<void(const char* what, std::size_t done, std::size_t total)>& progress,
                          const MeshLoader& load) {
  const auto tell = [&](const char* what, std::size_t done, std::size_t total) {
    if (progress) progress(what, done, total);
  };
  tell("reading the recording", 0, 0);
  const Recording recording = read_recording(path);
  const std::vector<RecordFrame>& rows = recording.frames;
  if (rows.empty()) throw Error(path + ": has no rows");
  SceneOptions how;
  how.progress = [&](std::size_t done, std::size_t total) { tell("reading mesh files", done, total); };
  how.load = load;
  SceneFile file = load_recorded_scene(path, recording.info, scene, how);
  std::vector<std::string> inputs = file.files;
  inputs.insert(inputs.end(), {path, recording_info_path(path)});
  refuse_to_replace(html, inputs);
  const MeshStructures made(file.scene.parts, file.scene.contact.narrowphase,
                            [&](std::size_t done, std::size_t total) { tell("building hierarchies", done, total); });
  Follower follower(file.scene, path, rows.front().x);
  const std::size_t every = (rows.size() + max_frames - 1) / max_frames;
  const Frames pictures = frames_of(rows, every, follower, tell);
  if (2 * follower.strayed() > rows.size())
    throw Error(path + ": does not fit this scene: the part would intersect another one for " +
                std::to_string(follower.strayed()) + " of " + std::to_string(rows.size()) + " rows");
  tell("making the page", 0, 0);
  Bundle bundle;
  held_part(file.scene).pose = rows.front().x;
  add_scene(bundle, file.scene, follower.loop().center());
  // After a change of the scene the script may be of another part.
  if (recording.info.continues.empty()) add_script(bundle, file.script);
  bundle.about["mode"] = "replay";
  bundle.about["up"] = to_string(file.up);
  bundle.about["virtual_time"] =
      std::all_of(rows.begin(), rows.end(), [](const auto& row) { return row.tick_us == 0; });
  bundle.about["title"] = path.substr(path.find_last_of('/') + 1);
  bundle.about["frames"] = bundle.add(pictures.frames);
  bundle.about["pairs"] = bundle.add(pictures.pairs);
  bundle.about["pair_begin"] = bundle.add(pictures.pair_begin);
  bundle.about["forces"] = bundle.add(pictures.forces);
  bundle.about["force_begin"] = bundle.add(pictures.force_begin);
  bundle.about["notes"] = notes_of(recording, every, !pictures.forces.empty());
  return bundle.bytes();
}

void serve_replay(const std::string& bundle, const std::function<std::string()>& make_review, const Address& address,
                  const std::atomic<bool>& stop, const std::function<void(const Server&)>& announce) {
  ReplaySource source(bundle, make_review);
  Server server(address, source);
  announce(server);
  while (!stop) std::this_thread::sleep_for(kReplayPoll);
}

void write_replay(const std::string& bundle, const std::string& path) {
  write_file(path, apps::view_file(bundle));
}

}  // namespace tegotae::view
