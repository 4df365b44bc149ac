// Frames of any bits, and files that go away.
#pragma once

#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <random>
#include <string>

#include "tegotae/record/recording.hpp"

namespace tegotae::test {

/// A file name that goes away with it, and so does what is written beside it.
struct TemporaryFile {
  explicit TemporaryFile(const std::string& ending = "") : path_(pattern() + ending) {
    close(mkstemps(path_.data(), static_cast<int>(ending.size())));
    path = path_;
  }
  ~TemporaryFile() {
    std::filesystem::remove(path);
    std::filesystem::remove(recording_info_path(path));
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  std::string path;

 private:
  static std::string pattern() {
    return (std::filesystem::temp_directory_path() / "tegotae_recording_XXXXXX").string();
  }
  std::string path_;
};

/// Any bits, all finite.
inline double random_double(std::mt19937_64& rng) {
  for (;;) {
    const std::uint64_t bits = rng();
    double value;
    std::memcpy(&value, &bits, sizeof value);
    if (std::isfinite(value)) return value;
  }
}

inline RecordFrame random_frame(std::mt19937_64& rng) {
  const auto number = [&rng] { return random_double(rng); };
  RecordFrame f;
  f.tick = rng();
  f.substep = static_cast<std::uint32_t>(rng());
  f.t = number();
  for (Pose* X : {&f.y, &f.x}) {
    X->p = Vec3(number(), number(), number());
    X->q = Quat(number(), number(), number(), number());
  }
  f.wrench.force = Vec3(number(), number(), number());
  f.wrench.torque = Vec3(number(), number(), number());
  f.contacts = static_cast<int>(rng());
  f.gap = number();
  f.tick_us = number();
  f.lag_reason = static_cast<LagReason>(rng() % kLagReasons);
  return f;
}

/// Forces of any bits.
inline ContactForces random_forces(std::mt19937_64& rng) {
  const auto number = [&rng] { return random_double(rng); };
  const auto vector = [&] { return Vec3(number(), number(), number()); };
  ContactForces out;
  out.count = static_cast<int>(rng() % (ContactForces::kMax + 1));
  for (int i = 0; i < out.count; ++i) {
    ContactForce& c = out.items[static_cast<std::size_t>(i)];
    c.part = PartId{static_cast<std::uint32_t>(rng())};
    c.point = vector();
    c.n = vector();
    c.gap = number();
    c.force = number();
    if (rng() % 2 == 0) continue;  // no friction
    c.mu = 0.3;
    c.friction = vector();
    c.slides = rng() % 2 == 0;
  }
  out.lag = {vector(), vector()};
  return out;
}

}  // namespace tegotae::test
