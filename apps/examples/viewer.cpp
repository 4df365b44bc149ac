// A CAD-style viewer: 400 fixed parts around the held one. The contact loop runs in a thread of its own; the viewer's
// thread draws and, while that goes on, adds a part, moves it, and removes it again: it changes its scene and gives it
// to the loop, which goes over to it between two ticks.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>

#include "tegotae/core/error.hpp"
#include "tegotae/mesh/load.hpp"
#include "tegotae/sim/haptic_loop.hpp"

using namespace tegotae;

namespace {

std::atomic<bool> closing{false};

/// The contact loop, with a pen that goes to and fro by 25 mm.
void haptics(HapticLoop& loop) {
  const Pose home = loop.latest();
  for (int tick = 0; !closing; ++tick) {
    loop.step({home.q, home.p + Vec3(0.025 * std::sin(6e-3 * tick), 0, 0)}, 1e-3);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

/// Gives the loop the scene with the held part where it is now, again and again until it is in force.
void show(HapticLoop& loop, Scene& scene) {
  std::uint64_t number = loop.change_in_force() + 1;
  while (loop.change_in_force() < number) {
    scene.parts.front().pose = loop.latest();
    try {
      number = loop.change(scene);
    } catch (const Error&) {  // the held part is where a part should go: a real viewer tells the user
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: viewer FOLDER  (with hole_20.obj and peg_0.94.obj)\n");
    return 2;
  }
  const auto load = [&](const std::string& file) {
    return std::make_shared<TriangleMesh>(load_mesh(argv[1] + ("/" + file), unit_length("mm")));
  };
  const auto block = load("hole_20.obj"), peg = load("peg_0.94.obj");
  Scene scene;
  scene.parts.push_back({"peg", peg, Pose{Quat::Identity(), Vec3(0, 0, 0.1)}, true});
  for (int i = 0; i < 400; ++i)
    scene.parts.push_back({"block " + std::to_string(i), block,
                           Pose{Quat::Identity(), Vec3(0.07 * (i % 20 - 10), 0.07 * (i / 20 - 10), 0)}});
  HapticLoop loop(scene);
  std::thread thread(haptics, std::ref(loop));

  const auto edit = [&](const char* what, auto change) {
    change(scene);
    show(loop, scene);
    double farthest = 0;
    for (int frame = 0; frame < 120; ++frame) {  // draw here
      farthest = std::max(farthest, loop.latest().p.x());
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    std::printf("%s: %zu parts, the held one goes to x = %.1f mm\n", what, scene.parts.size(), 1e3 * farthest);
  };
  edit("add", [&](Scene& s) { s.parts.push_back({"post", peg, Pose{Quat::Identity(), Vec3(0.05, 0, 0.1)}}); });
  edit("move", [&](Scene& s) { s.parts.back().pose.p.x() = 0.04; });
  edit("remove", [&](Scene& s) { s.parts.pop_back(); });
  closing = true;
  thread.join();
}
