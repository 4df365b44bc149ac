// A page that changes the parts of a run while it goes on: nothing starts anew, nothing intersects, every recording is
// of one scene.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>

#include "bodies.hpp"
#include "catch.hpp"
#include "child_process.hpp"
#include "fcl_oracle.hpp"
#include "spawn.hpp"
#include "tegotae/import/write.hpp"
#include "tegotae/record/recording.hpp"
#include "tegotae/scene_file/scene_file.hpp"
#include "view/watcher.hpp"

using namespace tegotae;
using namespace tegotae::test;
using Catch::Contains;
using nlohmann::json;

namespace {

enum Number { floor_, wall, post, rock, block, stick };  // of the parts, in the scene file's order

/// A block over a floor, between a wall and a post, a stick on the other side of the wall, and a rock far away that is
/// larger than all of it. The hand swings by 15 mm through floor, wall and post.
std::string write_scene(const TempFolder& folder) {
  const auto part = [&](const std::string& name, const Vec3& size, const Vec3& p, const char* more = "") {
    write_ply(box(size), folder / (name + ".ply"), 1);
    return "[[part]]\nname = \"" + name + "\"\nmesh = \"" + name + ".ply\"\nposition = [" + std::to_string(p.x()) +
           ", " + std::to_string(p.y()) + ", " + std::to_string(p.z()) + "]\n" + more;
  };
  std::string rows = "t,px,py,pz,qw,qx,qy,qz\n";
  for (int i = 0; i < 6000; ++i) {
    const double t = 0.02 * i;
    rows += std::to_string(t) + "," + std::to_string(0.015 * std::sin(3 * t)) + "," +
            std::to_string(0.005 * std::sin(2 * t)) + "," + std::to_string(0.012 - 0.004 * std::sin(5 * t)) +
            ",1,0,0,0\n";
  }
  folder.write("swing.csv", rows);
  folder.write("scene.toml", part("floor", Vec3(0.3, 0.2, 0.01), Vec3(0, 0, -0.005)) +
                                 part("wall", Vec3(0.01, 0.2, 0.05), Vec3(0.0251, 0, 0.03)) +
                                 part("post", Vec3(0.01, 0.01, 0.05), Vec3(-0.025, 0, 0.03)) +
                                 part("rock", Vec3(0.3, 0.3, 0.3), Vec3(0, 1, 0.155)) +
                                 part("block", Vec3(0.02, 0.02, 0.02), Vec3(0, 0, 0.012), "held = true\n") +
                                 part("stick", Vec3(0.01, 0.01, 0.03), Vec3(0.08, 0, 0.03)) +
                                 "[device]\nscript = \"swing.csv\"\n");
  return folder / "scene.toml";
}

/// Processes that keep every processor busy.
class Load {
 public:
  Load() {
    for (int i = 0; i < 2; ++i)
      busy_.push_back(std::make_unique<ChildProcess>([](const auto&) {
        for (volatile unsigned n = 0;; n = n + 1) {
        }
      }));
  }

 private:
  std::vector<std::unique_ptr<ChildProcess>> busy_;
};

/// A page that sees to it that frames go on, and of which parts they are.
class Page {
 public:
  explicit Page(const Served& s) : served_(s), watcher_(s) { next(); }

  /// The next frame; its tick is later than the last one's.
  void next() {
    const long tick = watcher_.next();
    REQUIRE(tick > tick_);
    tick_ = tick;
  }
  void watch(int frames) {
    for (int i = 0; i < frames; ++i) next();
  }
  long tick() const { return tick_; }
  int generation() const { return static_cast<int>(watcher_.row()[32]); }

  int ask_for(const json& what, std::string* answer = nullptr) const {
    return ask(served_.port, command(served_, what.dump()), answer);
  }
  /// An edit that goes through, and the run in it.
  void edit(const json& what) {
    CAPTURE(what.dump());
    const int before = generation();
    std::string answer;
    const int status = ask_for(what, &answer);
    CAPTURE(answer);
    REQUIRE(status == 200);
    ++edits_;
    // First come the frames that have piled up meanwhile: as many as the change took time for.
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (generation() == before && std::chrono::steady_clock::now() < until) next();
    CHECK(generation() == before + 1);
    watch(12);
  }
  void refuse(const json& what, const std::string& why) {
    CAPTURE(what.dump());
    const int before = generation();
    std::string answer;
    CHECK(ask_for(what, &answer) == 400);
    CHECK_THAT(answer, Contains(why));
    watch(6);
    CHECK(generation() == before);
  }
  json parts() const {
    std::string answer;
    REQUIRE(ask(served_.port, get(served_, "/parts"), &answer) == 200);
    return json::parse(answer.substr(answer.find("\r\n\r\n") + 4));
  }
  int edits() const { return edits_; }

 private:
  const Served& served_;
  Watcher watcher_;
  long tick_ = -1;
  int edits_ = 0;
};

json move(int part, double x, double y, double z) {
  return {{"do", "move"}, {"part", part}, {"by", {x, y, z}}, {"turn", {0, 0, 0}}};
}
json act(const char* what, int part) {
  return {{"do", what}, {"part", part}};
}

std::string numbered(const TempFolder& folder, std::size_t number, const std::string& extension) {
  return folder / ("run" + (number == 1 ? "" : "." + std::to_string(number)) + extension);
}

struct RecordedSegment {
  Recording recording;
  SceneFile scene;
};

/// The recordings of a run, each with the scene that it names.
std::vector<RecordedSegment> recordings(const TempFolder& folder, std::size_t count, const std::string& extension) {
  std::vector<RecordedSegment> all;
  for (std::size_t k = 1; k <= count; ++k) {
    CAPTURE(k);
    Recording recording = read_recording(numbered(folder, k, extension));
    const RecordingInfo& info = recording.info;
    CHECK(recording.damage.empty());
    REQUIRE(!recording.frames.empty());
    const std::string named = k == 1 ? info.scene : folder / info.scene;
    CHECK(named == (k == 1 ? folder / "scene.toml" : numbered(folder, k, ".toml")));
    SceneFile scene = load_scene(named);
    const auto held = std::find_if(scene.scene.parts.begin(), scene.scene.parts.end(), [](auto& p) { return p.held; });
    CHECK(info.held == held->name);
    // They name each other, without folders.
    CHECK(info.continues == (k == 1 ? "" : numbered(folder, k - 1, extension).substr((folder / "").size())));
    CHECK(info.continued_by == (k == count ? "" : numbered(folder, k + 1, extension).substr((folder / "").size())));
    all.push_back({std::move(recording), std::move(scene)});
  }
  CHECK_FALSE(std::filesystem::exists(numbered(folder, count + 1, extension)));
  CHECK_FALSE(std::filesystem::exists(numbered(folder, count + 1, ".toml")));
  return all;
}

/// FCL on every pose, in the scene of its recording.
void check_free(const std::vector<RecordedSegment>& all) {
  for (const RecordedSegment& s : all) {
    const FclOracle oracle(s.scene.scene);
    std::size_t intersecting = 0;
    for (const RecordFrame& f : s.recording.frames) intersecting += oracle.intersecting(f.x).empty() ? 0 : 1;
    CAPTURE(s.scene.path);
    CHECK(intersecting == 0);
  }
}

/// Ticks count on, one by one, over all recordings; the held part goes on from where it was, or starts where the scene
/// puts it, and nowhere jumps.
void check_going_on(const std::vector<RecordedSegment>& all) {
  const RecordFrame* last = nullptr;
  std::string held;
  for (const RecordedSegment& s : all) {
    CAPTURE(s.scene.path);
    bool first = true;
    for (const RecordFrame& f : s.recording.frames) {
      const bool another = s.recording.info.held != held;
      if (last != nullptr) {
        REQUIRE(f.tick - last->tick == (f.substep == 0 ? 1u : 0u));
        REQUIRE(f.t >= last->t);
        // Of a lag a tick makes up a tenth of the part's radius (17 mm) or twice the way of the pen (0.1 m/s).
        if (!another) REQUIRE((f.x.p - last->x.p).norm() < 1.8e-3 + 0.4 * (f.t - last->t));
        REQUIRE((f.wrench.force - last->wrench.force).norm() < 0.1 + 3000 * (f.t - last->t + 2e-3));
      }
      if (first && another) {
        const auto part =
            std::find_if(s.scene.scene.parts.begin(), s.scene.scene.parts.end(), [](auto& p) { return p.held; });
        CHECK((f.x.p - part->pose.p).norm() < 40e-6);  // parted from what it touches
        CHECK((f.y.p - f.x.p).norm() == 0);            // the pen means the part where it is
      }
      held = s.recording.info.held;
      first = false;
      last = &f;
    }
  }
}

/// After another part was taken the force goes to zero, and comes on again from a small one.
void check_force_after(const RecordedSegment& s) {
  CAPTURE(s.scene.path);
  const double begin = s.recording.frames.front().t;
  bool off = false;
  double most = 0;
  for (const RecordFrame& f : s.recording.frames) {
    if (f.t - begin > 0.2) break;
    if (!off) off = f.wrench.force.norm() == 0 && f.t - begin > 2e-3;
    // It ramps in over 0.2 s from then on: of no more than the device's 8.5 N.
    if (off) most = std::max(most, f.wrench.force.norm());
    if (f.t - begin > 0.02) CHECK(off);
  }
  CHECK(off);
  CHECK(most < 8.5);
}

}  // namespace

TEST_CASE("parts are held, moved, removed and added back while a pen runs and the machine is busy") {
  const TempFolder folder;
  Served s({"tegotae", "run", write_scene(folder), "--view", "--record", folder / "run.csv", "--json"});
  const Load load;
  Page page(s);
  page.watch(20);
  page.edit(act("remove", wall));
  page.edit(move(post, -0.01, 0, 0));
  page.refuse(move(rock, 0, -1, 0), "parts \"block\" and \"rock\" intersect");
  page.refuse(act("remove", block), "held");
  page.refuse(act("remove", wall), "not in the scene");
  page.refuse(act("add", post), "is in the scene");
  page.refuse(act("hold", 17), "no such part");
  page.refuse(move(post, 1e9, 0, 0), "out of range");
  page.edit(act("hold", stick));
  CHECK(page.parts().at("parts")[stick].at("held") == true);
  CHECK(page.parts().at("parts")[wall].at("removed") == true);
  page.edit(move(block, -0.1, 0, 0.02));
  page.edit(act("add", wall));
  page.edit(act("hold", block));
  page.edit(move(floor_, 0, 0, -0.002));
  page.watch(20);
  s.interrupt();
  REQUIRE(s.wait() == 0);

  const json summary = json::parse(s.out());
  CHECK(summary.at("penetrating") == 0);
  CHECK(summary.at("record_dropped") == 0);
  CHECK(summary.at("recordings").size() == static_cast<std::size_t>(page.edits()) + 1);
  CHECK(summary.at("ticks").get<long>() >= page.tick());
  const std::vector<RecordedSegment> all = recordings(folder, static_cast<std::size_t>(page.edits()) + 1, ".csv");
  check_free(all);
  check_going_on(all);
  check_force_after(all[3]);
  check_force_after(all[6]);

  // The tick that goes over to a change is no longer than others may be: the budget, or what the machine makes of it.
  std::vector<double> tick_us;
  double longest_other = 0;
  for (std::size_t k = 1; k < all.size(); ++k) {
    const auto& frames = all[k].recording.frames;
    tick_us.push_back(frames.front().tick_us);
    for (std::size_t i = 1; i < frames.size(); ++i) longest_other = std::max(longest_other, frames[i].tick_us);
  }
  std::sort(tick_us.begin(), tick_us.end());
  std::cout << "ticks that went over to a change: median " << tick_us[tick_us.size() / 2] << ", longest "
            << tick_us.back() << " us; longest of the others " << longest_other << " us\n";
  CHECK(tick_us[tick_us.size() / 2] <= std::max(1e6 * ContactSettings().tick_budget, longest_other));
}

TEST_CASE("a run in virtual time that stands takes changes, and goes on in them") {
  const TempFolder folder;
  Served s({"tegotae", "run", write_scene(folder), "--view", "--fast", "--record", folder / "run.mcap", "--json"});
  const auto ask_for = [&](const json& what) { return ask(s.port, command(s, what.dump())); };
  CHECK(ask_for({{"do", "step"}, {"ticks", 300}}) == 200);
  Page page(s);
  CHECK(ask_for(act("remove", wall)) == 200);
  CHECK(ask_for(act("hold", stick)) == 200);
  CHECK(ask_for({{"do", "step"}, {"ticks", 500}}) == 200);
  CHECK(ask_for(move(rock, 0, -1, 0)) == 400);
  while (page.tick() < 700) page.next();
  CHECK(page.generation() == 3);
  s.interrupt();
  CHECK(s.wait() == 0);
  CHECK(json::parse(s.out()).at("penetrating") == 0);
  const std::vector<RecordedSegment> all = recordings(folder, 3, ".mcap");
  check_free(all);
  check_going_on(all);
}

TEST_CASE("another part is taken by the pen of another process, which is not lost") {
  const TempFolder folder;
  const std::string name = "view-edit-" + std::to_string(::getpid()), scene = write_scene(folder);
  Program device(
      {TEGOTAE_BIN_DIR "/tegotae-device", "--type", "simulated", "--name", name, "--script", folder / "swing.csv"});
  device.line();
  Served s({"tegotae", "run", scene, "--device", "shm:" + name, "--view", "--record", folder / "run.csv", "--json"});
  Page page(s);
  page.watch(10);
  page.edit(act("hold", stick));
  page.edit(act("remove", block));
  page.edit(act("add", block));
  page.edit(act("hold", block));
  s.interrupt();
  CHECK(s.wait() == 0);
  CHECK(json::parse(s.out()).at("device_losses") == 0);
  CHECK(device.end(SIGINT) == 0);
  const std::vector<RecordedSegment> all = recordings(folder, 5, ".csv");
  check_free(all);
  check_going_on(all);
  // The stick swings as the pen does.
  double way = 0;
  for (const RecordFrame& f : all[1].recording.frames)
    way = std::max(way, (f.x.p - all[1].recording.frames.front().x.p).norm());
  CHECK(way > 1e-3);
}
