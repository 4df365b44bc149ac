// An application as a process of its own, to be killed: holds a box on a pen of another process and presses it onto a
// floor. Says on stdout when the device is lost and back, with the times and the part's place. fault_application DEVICE
#include <time.h>

#include <cstdio>

#include "device/press_scene.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/transport/attachment.hpp"

using namespace tegotae;

namespace {

void say(const char* what, std::int64_t now, std::int64_t before, std::int64_t heartbeat, const Pose& X) {
  std::printf("%s %lld %lld %lld %.17g %.17g %.17g %.17g\n", what, static_cast<long long>(now),
              static_cast<long long>(before), static_cast<long long>(heartbeat), X.p.x(), X.p.y(), X.p.z(), X.q.w());
  std::fflush(stdout);
}

void run(const char* device) {
  const Scene scene = test::press_scene();
  HapticLoop loop(scene);
  Attachment pen(device, loop.coupling(), loop.center());
  PenSample sample;
  bool following = false;
  std::int64_t now = monotonic_ns(), before = now;
  for (std::uint64_t tick = 0;; ++tick) {
    const timespec millisecond = {0, 1'000'000};
    nanosleep(&millisecond, nullptr);
    before = now;
    now = monotonic_ns();
    const bool there = pen.read(sample, now);
    // Every tick's own clock reading goes out with what it noticed: a test then tells this loop's lateness from the
    // silence of the device.
    if (there && !following) say("back", now, before, sample.heartbeat_ns, loop.report().proxy.X);
    if (following && !pen.connected()) say("lost", now, before, sample.heartbeat_ns, loop.report().proxy.X);
    following = there || (following && pen.connected());
    if (there) loop.step(sample.state.pose, 1e-9 * static_cast<double>(now - before));
    ProxyState proxy = loop.report().proxy;
    if (!there) proxy.velocity = {};
    pen.publish(proxy, tick, sample.state.sequence, monotonic_ns(), there ? loop.report().planes : ContactPlanes{});
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    run(argv[1]);
  } catch (const Error& e) {
    std::fprintf(stderr, "fault_application: %s\n", e.what());
    return 2;
  }
}
