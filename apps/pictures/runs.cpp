// The runs behind the pictures of docs/concepts.md: doc_pictures MODELS OUT writes a table (CSV) for each of them into
// OUT, which draw.py draws. Virtual time and no budget, so the same build gives the same tables. Only what is on the
// clock does not repeat: `doc_pictures MODELS docs/pictures deadline` writes that table, which is kept beside the
// pictures.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <string>

#include "tegotae/core/error.hpp"
#include "tegotae/device/simulated_device.hpp"
#include "tegotae/import/load.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/servo/servo.hpp"
#include "tegotae/transport/contact_link.hpp"

using namespace tegotae;

namespace {

constexpr double kMm = 1e-3;
std::string models, out;

using Mesh = std::shared_ptr<const TriangleMesh>;

Mesh model(const char* file) {
  return std::make_shared<TriangleMesh>(load_mesh(models + "/" + file, unit_length("mm")));
}

Mesh box(const Vec3& size) {
  TriangleMesh mesh;
  mesh.name = "box";
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back(size.cwiseProduct(Vec3((i & 1) - 0.5, (i >> 1 & 1) - 0.5, (i >> 2) - 0.5)));
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return std::make_shared<TriangleMesh>(weld(mesh));
}

Pose at(double x_mm, double z_mm, double tilt_deg = 0) {
  return {Quat(Eigen::AngleAxisd(tilt_deg * std::acos(-1.0) / 180, Vec3::UnitY())), Vec3(x_mm * kMm, 0, z_mm * kMm)};
}

Scene scene_of(const Mesh& fixed, const Mesh& held, const Pose& start) {
  Scene scene;
  scene.parts.push_back({"fixed", fixed, Pose{}, false});
  scene.parts.push_back({"held", held, start, true});
  scene.contact.tick_budget = std::numeric_limits<double>::infinity();
  return scene;
}

/// A table of numbers with a header row.
class Table {
 public:
  Table(const std::string& name, const char* header) : file_(std::fopen((out + "/" + name + ".csv").c_str(), "w")) {
    if (!file_) throw Error(out + "/" + name + ".csv: cannot be written");
    std::fprintf(file_, "%s\n", header);
  }
  ~Table() { std::fclose(file_); }
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;
  void row(std::initializer_list<double> values) {
    const char* between = "";
    for (const double value : values) std::fprintf(file_, "%s%.9g", between, value), between = ",";
    std::fprintf(file_, "\n");
  }

 private:
  std::FILE* file_;
};

/// Hand, pen, servo and contact loop taking turns, a millisecond each.
struct Run {
  Scene scene;
  StylusScript script;
  ServoSettings servo = {};
  int contact_period_ms = 1;
  std::function<bool(int ms)> silent = [](int) { return false; };  // the application publishes nothing

  void operator()(const std::function<void(int ms, const PenSample&, const TickReport&)>& observe) {
    HapticLoop loop(scene);
    SimulatedDevice pen({}, script, loop.center());
    Channel channel = Channel::create();
    Servo fast(pen, channel, servo);
    ContactLink link(channel, loop.coupling(), loop.center());
    pen.start();
    const int end = static_cast<int>(1e3 * script.end());
    for (int ms = 0; ms <= end; ++ms) {
      const std::int64_t now_ns = 1'000'000LL * ms;
      fast.tick(now_ns);
      PenSample sample;
      link.read(sample);
      if (ms % contact_period_ms == 0) {
        const TickReport& tick = loop.step(sample.state.pose, 1e-3 * contact_period_ms);
        if (!silent(ms)) link.publish(tick.proxy, ms, sample.state.sequence, now_ns, tick.planes);
      }
      observe(ms, sample, loop.report());
      pen.advance(1e-3);
    }
    pen.stop();
  }
};

/// A cube pressed on a floor: pen, part, force, gap.
void coupling() {
  Run run{scene_of(model("floor.obj"), model("cube.obj"), at(0, 25)),
          StylusScript({{0, at(0, 25)}, {0.5, at(0, 15)}, {0.8, at(0, 15)}, {1.3, at(0, 25)}})};
  Table table("coupling", "t,pen,part,force,gap");
  run([&](int ms, const PenSample& pen, const TickReport& tick) {
    table.row({1e-3 * ms, pen.state.pose.p.z(), tick.proxy.X.p.z(), pen.wrench.force.z(), tick.gap});
  });
}

/// A peg held tilted in its hole: both poses, and what limits it.
void contacts() {
  HapticLoop loop(scene_of(model("hole_20.obj"), model("peg_0.94.obj"), at(0, 45)));
  const auto go = [&](const Pose& from, const Pose& to, int ms) {
    for (int i = 1; i <= ms; ++i) {
      const double s = static_cast<double>(i) / ms;
      loop.step({from.q.slerp(s, to.q), (1 - s) * from.p + s * to.p}, 1e-3);
    }
  };
  const Pose above = at(0, 45), in = at(0, 2), pressed = at(2, 2, 7);
  go(above, in, 400);
  go(in, pressed, 300);
  go(pressed, pressed, 300);
  const Pose& X = loop.report().proxy.X;
  Table poses("contacts_poses", "x,z,qw,qy");
  for (const Pose& p : {X, pressed}) poses.row({p.p.x(), p.p.z(), p.q.w(), p.q.y()});
  Table table("contacts", "x,y,z,nx,ny,nz,gap");
  for (const Contact& c : loop.constraints()) {
    if (c.age == kOneShotAge) continue;
    const Vec3 p = X * loop.center() + c.r;
    table.row({p.x(), p.y(), p.z(), c.n.x(), c.n.y(), c.n.z(), c.gap});
  }
}

/// A pen that passes through a sheet of 0.2 mm in steps of 8 mm: its poses, and the sub-steps of the part.
void way() {
  HapticLoop loop(scene_of(box(Vec3(80, 60, 0.2) * kMm), box(Vec3(8, 8, 8) * kMm), at(-25, 14, 20)));
  Table table("way", "tick,pen_x,pen_z,x,z,qw,qy");
  for (int tick = 0; tick <= 12; ++tick) {
    const double s = std::min(tick, 7);
    const Pose pen = at(-25 + 6 * s, 14 - 5.3 * s, 20 + 4 * s);
    for (const Pose& p : loop.step(pen, 1e-3).substeps)
      table.row({static_cast<double>(tick), pen.p.x(), pen.p.z(), p.p.x(), p.p.z(), p.q.w(), p.q.y()});
  }
}

/// An application that says nothing for a tenth of a second while a cube is pressed on the floor.
void safety() {
  Run run{
      scene_of(model("floor.obj"), model("cube.obj"), at(0, 22)),
      StylusScript(
          {{0, at(0, 22)}, {0.3, at(0, 15)}, {1.0, at(0, 15)}, {1.3, at(0, 22)}, {1.6, at(0, 15)}, {2.0, at(0, 15)}})};
  run.silent = [](int ms) { return ms >= 600 && ms < 700; };
  Table table("safety", "t,pen,wanted,force,reason");
  const CouplingSettings k;
  run([&](int ms, const PenSample& pen, const TickReport& tick) {
    const Wrench wanted = coupling_wrench(k, tick.proxy, pen.state.pose, pen.state.velocity, Vec3::Zero());
    table.row(
        {1e-3 * ms, pen.state.pose.p.z(), wanted.force.z(), pen.wrench.force.z(), static_cast<double>(pen.reason)});
  });
}

/// The same press with a contact loop at 1 kHz, and at 100 Hz with and without the servo's local model.
void rates() {
  Table table("rates", "case,t,force");
  for (int i = 0; i < 3; ++i) {
    std::vector<StylusScript::Key> keys = {{0, at(0, 22)}};
    for (int k = 1; k <= 60; ++k) keys.push_back({0.01 * k, at(0, 20.5 - 2.5 * std::sin(0.25 * k))});
    Run run{scene_of(model("floor.obj"), model("cube.obj"), at(0, 22)), StylusScript(keys)};
    run.contact_period_ms = i == 0 ? 1 : 10;
    run.servo.local_model = i != 2;
    run([&](int ms, const PenSample& pen, const TickReport&) {
      table.row({static_cast<double>(i), 1e-3 * ms, pen.wrench.force.z()});
    });
  }
}

/// A peg rocked into its hole with less and less time for a tick, on the clock.
void deadline() {
  Table table("deadline", "budget,t,lag,cut");
  const Mesh hole = model("hole_20.obj"), peg = model("peg_0.99.obj");
  for (const double budget : {0.8e-3, 0.1e-3, 0.05e-3}) {
    Scene scene = scene_of(hole, peg, at(0, 30));
    scene.contact.tick_budget = budget;
    HapticLoop loop(scene);
    for (int ms = 0; ms <= 450; ++ms) {
      const double s = std::min(ms, 300) / 300.0;
      const Pose pen = at(0.6 * std::sin(20 * s), 30 - 45 * s, 1.7 * std::sin(12 * s));
      const TickReport& tick = loop.step(pen, 1e-3);
      table.row({budget, 1e-3 * ms, (tick.proxy.X.p - pen.p).norm(), tick.flags.timed_out ? 1.0 : 0.0});
    }
  }
}

}  // namespace

int main(int argc, char** argv) try {
  const bool on_the_clock = argc == 4 && std::strcmp(argv[3], "deadline") == 0;
  if (argc != 3 && !on_the_clock) return std::fprintf(stderr, "usage: doc_pictures MODELS OUT [deadline]\n"), 2;
  models = argv[1];
  out = argv[2];
  if (on_the_clock) return deadline(), 0;
  coupling();
  contacts();
  way();
  safety();
  rates();
} catch (const Error& e) {
  std::fprintf(stderr, "doc_pictures: %s\n", e.what());
  return 1;
}
