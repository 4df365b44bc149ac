// A resolver of one's own: Hildreth's method (1957), which goes through the limits in turn and pushes the motion just
// out of each that it breaks, until none is broken. It finds the same motion as the library's least constraint, only
// more slowly; whatever it answers, the parts stay apart, because the loop certifies every motion before it makes it.
#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <tegotae/tegotae.hpp>
#include <vector>

using namespace tegotae;

class Hildreth : public Resolver {
 public:
  explicit Hildreth(int capacity) : force_(static_cast<std::size_t>(capacity)) {}

  Resolution resolve(const LowRankMatrix& rows, const double* bounds, const Vec6& wanted) noexcept override {
    Resolution r;
    r.motion = wanted;
    std::fill(force_.begin(), force_.end(), 0.0);
    for (r.iterations = 1; r.iterations <= 20000; ++r.iterations) {
      double worst = 0;  // m
      for (int i = 0; i < rows.rows(); ++i) {
        const Vec6 g = rows.row(i);
        const double missing = (bounds[i] - g.dot(r.motion)) / g.squaredNorm();
        double& force = force_[static_cast<std::size_t>(i)];
        const double change = std::max(missing, -force);  // contacts push and do not pull
        force += change;
        r.motion += change * g;
        worst = std::max(worst, std::abs(change) * g.norm());
      }
      if (worst < 1e-9) {
        r.status = ResolveStatus::solved;
        return r;
      }
    }
    r.motion.setZero();
    return r;  // stalled: the part stays where it is in this tick
  }
  bool projects() const override { return true; }

 private:
  std::vector<double> force_;  // of each limit
};

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: custom_resolver FOLDER  (with hole_20.obj and peg_0.94.obj)\n");
    return 2;
  }
  const std::string folder = argv[1];
  Scene scene;
  scene.add_fixed("hole", load_mesh(folder + "/hole_20.obj", unit_length("mm")));
  scene.add_held("peg", load_mesh(folder + "/peg_0.94.obj", unit_length("mm")), {Quat::Identity(), Vec3(0, 0, 0.03)});
  scene.contact.tick_budget = std::numeric_limits<double>::infinity();
  HapticLoop standard(scene);
  scene.contact.custom_resolver = [](int capacity) { return std::make_unique<Hildreth>(capacity); };
  HapticLoop own(scene);
  double farthest = 0;
  for (int ms = 0; ms <= 1500; ++ms) {
    const Vec3 tilt(0.05 * std::min(1.0, ms / 500.0), 0, 0);
    const Pose pen{rotation(tilt), Vec3(0.0005, 0, 0.03 - 2.5e-5 * ms)};  // m: tilted into the hole, until it jams
    const Vec3 a = standard.step(pen, 1e-3).proxy.X.p, b = own.step(pen, 1e-3).proxy.X.p;
    farthest = std::max(farthest, (a - b).norm());
  }
  std::printf("both pegs went %.2f and %.2f mm down; never farther apart than %.3f mm\n",
              1e3 * (0.03 - standard.latest().p.z()), 1e3 * (0.03 - own.latest().p.z()), 1e3 * farthest);
}
