#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tegotae/device/simulated_device.hpp"
#include "tegotae/loop/scene.hpp"
#include "tegotae/operator/operator.hpp"

namespace tegotae::experiments {

/// What the pen's next-to-last sample and the held part were in a tick of the contact loop.
struct Sample {
  double t = 0;   ///< s
  Pose X, Y;      ///< of the held part's file frame, and where the pen wanted it
  Vec3 center;    ///< of mass of the held part, world, m
  Twist pen;      ///< velocity of the pen's body at the center of mass
  Wrench wrench;  ///< rendered on the pen at the center of mass
  int contacts = 0;
  std::int64_t held_back = 0;  ///< TickReport::unexplained_lag_ticks
};

/// Runs the scene in virtual time with servo, safety chain and simulated pen, 1 kHz, as `tegotae run` does, but with
/// any hand. `op` is shown the held part in every tick when it is not null. Ends after `seconds` or when `done` says
/// so.
std::vector<Sample> run_trial(Scene scene, const SimulatedDeviceSettings& pen, InputSource& hand, Operator* op,
                              double seconds, const std::function<bool(const Sample&)>& done);

/// Sum of TickReport::unexplained_lag_ticks over all loops that experiments have run in this process. Any thread adds.
std::atomic<std::int64_t>& unexplained_lag_ticks();

/// Names of the resolvers that the library knows, the default first, then the paper's, then its baselines.
std::vector<std::string> resolvers();

/// How many poses X of `samples`, about `most` of them evenly spread, intersect a fixed part by FCL's word.
std::int64_t count_intersecting(const Scene& scene, const std::vector<Sample>& samples, std::size_t most);

}  // namespace tegotae::experiments
