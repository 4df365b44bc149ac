#include "view/replay.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <thread>

#include "tegotae/core/error.hpp"
#include "tegotae/record/recording.hpp"
#include "tegotae/sim/haptic_loop.hpp"
#include "tegotae/sim/scene_file.hpp"
#include "view/bundle.hpp"
#include "view/frame_maker.hpp"
#include "view/server.hpp"
#include "view/wire.hpp"
#include "web/page.hpp"

namespace tegotae::view {
namespace {

// Frames that a page gets: more than pixels in a plot, and a file of some megabytes.
constexpr std::size_t kMostFrames = 12'000;
// Contacts show when something is in the way: the part is led this far (m) towards where the pen was.
constexpr double kPush = 5e-5;
// A part that is led and stays this far (m) behind the recording is held back by something that was not there.
constexpr double kAstray = 1e-4;
constexpr auto kPoll = std::chrono::milliseconds(50);

Part& held_part(Scene& scene) {
  for (Part& part : scene.parts)
    if (part.held) return part;
  throw Error("no part is held");
}

/// Leads a contact loop along the recorded poses.
class Follower {
 public:
  Follower(Scene scene, const std::string& path, const Pose& first) try
      : loop_((held_part(scene).pose = first, scene.contact.tick_budget = std::numeric_limits<double>::infinity(),
               scene)),
        maker_(scene) {
    for (const Vec3& v : held_part(scene).mesh->vertices) radius_ = std::max(radius_, (v - loop_.center()).norm());
  } catch (const Error& e) {
    throw Error(path + ": does not fit this scene: " + e.what());
  }

  const Vec3& center() const { return loop_.center(); }

  void step(const RecordFrame& row) {
    const Displacement push = displacement(row.x, row.y, loop_.center());
    const double size = push.dp.norm() + radius_ * push.dr.norm();
    loop_.step(displaced(row.x, loop_.center(), (size > kPush ? kPush / size : 1) * push), 1e-3);
    astray_ = displacement(loop_.report().proxy.X, row.x, loop_.center()).dp.norm() > kAstray;
    strayed_ += astray_ ? 1 : 0;
  }

  /// The frame of a row: recorded values, with the contacts found.
  void fill(const RecordFrame& row, Frame& frame) const {
    maker_.add_loop(loop_, frame);
    if (astray_) frame.pair_count = 0;
    frame.tick = row.tick;
    frame.t = row.t;
    store(row.x, frame.x);
    store(row.y, frame.y);
    store(row.wrench, frame.wrench);
    frame.gap = row.gap;
    frame.tick_us = row.tick_us;
    frame.servo_late_us = std::numeric_limits<double>::quiet_NaN();
    frame.contacts = static_cast<std::uint32_t>(row.contacts);
    frame.flags = row.contacts > 0 ? Frame::touching : 0u;
  }

  std::size_t strayed() const { return strayed_; }

 private:
  HapticLoop loop_;
  FrameMaker maker_;
  double radius_ = 0;  // of the held part about its center of mass
  bool astray_ = false;
  std::size_t strayed_ = 0;
};

/// All in the bundle.
class ReplaySource final : public ViewSource {
 public:
  explicit ReplaySource(std::string bundle) : bundle_(std::make_shared<const std::string>(std::move(bundle))) {}
  std::shared_ptr<const std::string> scene() const override { return bundle_; }
  const FrameRing* frames() const override { return nullptr; }
  std::string status() const override { return "{}"; }
  void command(const nlohmann::json&) override { throw Error("a recording takes no commands"); }

 private:
  std::shared_ptr<const std::string> bundle_;
};

std::string named_scene(const std::string& path, const std::string& scene) {
  if (scene.empty()) throw Error(path + ": does not say which scene it is of; add the scene file to the command");
  const std::filesystem::path beside = std::filesystem::path(path).parent_path() / scene;
  for (const std::filesystem::path& file : {std::filesystem::path(scene), beside})
    if (std::filesystem::exists(file)) return file.string();
  throw Error(path + ": its scene " + scene + " is gone; add the scene file to the command");
}

}  // namespace

std::string replay_bundle(const std::string& path, const std::string& scene) {
  const Recording recording = read_recording(path);
  const std::vector<RecordFrame>& rows = recording.frames;
  if (rows.empty()) throw Error(path + ": has no rows");
  SceneOptions how;
  how.hold = recording.info.held;
  SceneFile file = load_scene(scene.empty() ? named_scene(path, recording.info.scene) : scene, how);
  Follower follower(file.scene, path, rows.front().x);
  const std::size_t every = (rows.size() + kMostFrames - 1) / kMostFrames;
  std::vector<float> frames, pairs;
  std::vector<std::uint32_t> pair_begin;
  Frame frame;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    follower.step(rows[i]);
    if (i % every != 0 && i + 1 < rows.size()) continue;
    follower.fill(rows[i], frame);
    append_frame(frame, frames);
    pair_begin.push_back(static_cast<std::uint32_t>(pairs.size() / kPairFloats));
    append_pairs(frame, pairs);
  }
  if (2 * follower.strayed() > rows.size())
    throw Error(path + ": does not fit this scene: the part would stand in another one for " +
                std::to_string(follower.strayed()) + " of " + std::to_string(rows.size()) + " rows");
  Bundle bundle;
  held_part(file.scene).pose = rows.front().x;
  add_scene(bundle, file.scene, follower.center());
  bundle.about["mode"] = "replay";
  bundle.about["virtual_time"] =
      std::all_of(rows.begin(), rows.end(), [](const auto& row) { return row.tick_us == 0; });
  bundle.about["title"] = path.substr(path.find_last_of('/') + 1);
  bundle.about["frames"] = bundle.add(frames);
  bundle.about["pairs"] = bundle.add(pairs);
  bundle.about["pair_begin"] = bundle.add(pair_begin);
  nlohmann::json notes = nlohmann::json::array({"Contacts found anew from the recorded poses"});
  if (every > 1) notes.push_back("Every " + std::to_string(every) + "th of " + std::to_string(rows.size()) + " rows");
  if (!recording.damage.empty()) notes.push_back("The end is missing: " + recording.damage);
  bundle.about["notes"] = notes;
  return bundle.bytes();
}

void serve_replay(const std::string& bundle, const Address& address, const std::atomic<bool>& stop,
                  const std::function<void(const std::string&)>& announce) {
  ReplaySource source(bundle);
  Server server(address, source);
  announce(server.url());
  while (!stop) std::this_thread::sleep_for(kPoll);
}

void write_replay(const std::string& bundle, const std::string& path) {
  std::ofstream file(path, std::ios::binary);
  file << apps::view_file(bundle) << std::flush;
  if (!file) throw Error(path + ": cannot be written");
}

}  // namespace tegotae::view
