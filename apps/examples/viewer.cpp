// A CAD-style viewer: 400 fixed parts around the held one. The contact loop runs in a thread of its own; the viewer's
// thread draws and, while that goes on, adds a part, moves it, and removes it again: it changes its scene and gives it
// to the loop, which goes over to it between two ticks.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <tegotae/tegotae.hpp>
#include <thread>

using namespace tegotae;

namespace {

/// A hand that goes to and fro by 25 mm about where the part starts.
class ToAndFro final : public InputSource {
 public:
  explicit ToAndFro(const Pose& start) : start_(start) {}
  double begin() const noexcept override { return 0; }
  Pose start() const noexcept override { return start_; }
  HandTarget target(double t, const Pose&) noexcept override {
    const double angle = 6 * t;  // rad
    return {{start_.q, start_.p + Vec3(0.025 * std::sin(angle), 0, 0)}, {Vec3(0.15 * std::cos(angle), 0, 0)}};
  }

 private:
  Pose start_;
};

/// Gives the rig the scene, again and again until it is in force.
void show(Rig& rig, const Scene& scene) {
  while (true) {
    try {
      SceneChange change = rig.change(scene);
      if (change.wait(0.1) == ChangeState::in_force || !change.cancel()) return;
    } catch (const Error&) {  // the held part is in the way of the new part: a real viewer shows the message
    }
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
  const Pose start{Quat::Identity(), Vec3(0, 0, 0.1)};
  Scene scene;
  scene.parts.push_back({"peg", peg, start, true});
  for (int i = 0; i < 400; ++i)  // of one mesh
    scene.parts.push_back({"block " + std::to_string(i), block,
                           Pose{Quat::Identity(), Vec3(0.07 * (i % 20 - 10), 0.07 * (i / 20 - 10), 0)}});
  ToAndFro hand(start);
  SimulatedDevice pen({}, hand);
  Rig rig(scene, pen);
  rig.start();
  std::thread haptics([&rig] { rig.run(3600, [](const Rig&) {}); });

  const auto edit = [&](const char* what, auto change) {
    change(scene);
    show(rig, scene);
    double farthest = 0;
    for (int frame = 0; frame < 120; ++frame) {  // draw here
      farthest = std::max(farthest, rig.part().p.x());
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    std::printf("%s: %zu parts, the held one goes to x = %.1f mm\n", what, scene.parts.size(), 1e3 * farthest);
  };
  edit("add", [&](Scene& s) { s.parts.push_back({"post", peg, Pose{Quat::Identity(), Vec3(0.05, 0, 0.1)}}); });
  edit("move", [&](Scene& s) { s.parts.back().pose.p.x() = 0.04; });
  edit("remove", [&](Scene& s) { s.parts.pop_back(); });
  rig.request_stop();
  haptics.join();
}
