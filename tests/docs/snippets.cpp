// Pieces of code that the documents show and that are not whole programs, as they compile; check_code.py compares.
#include "tegotae/core/clock.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/transport/attachment.hpp"

using namespace tegotae;

/// docs/device-protocol.md: a contact loop of one's own.
void own_contact_loop(HapticLoop& loop, double dt, std::uint64_t ticks) {
  Attachment pen("shm:tegotae-pen", loop.coupling(), loop.center());
  for (std::uint64_t tick = 0; tick < ticks; ++tick) {
    PenSample sample;
    if (pen.read(sample, monotonic_ns())) loop.step(sample.state.pose, dt);  // otherwise the part stays
    pen.publish(loop.report().proxy, tick, sample.state.sequence, monotonic_ns(), loop.report().planes);
  }
}
