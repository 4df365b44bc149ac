#include "view/wire.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tegotae/core/error.hpp"

namespace tegotae::view {
namespace {

// Floats do not hold whole numbers above 2^24, nor milliseconds of a long run: two floats each.
constexpr std::uint64_t kTickSplit = 1u << 20;
constexpr int kMaxDepth = 3;
// Kinds of features (vertex, edge, face) of both parts.
constexpr double kFeaturePairs = 9;

void append(std::vector<float>& out, double value) {
  out.push_back(static_cast<float>(value));
}

std::string message(Message kind, const void* data, std::size_t bytes) {
  const std::uint32_t head[2] = {static_cast<std::uint32_t>(kind), static_cast<std::uint32_t>(bytes)};
  std::string out(reinterpret_cast<const char*>(head), sizeof head);
  return out.append(static_cast<const char*>(data), bytes);
}

}  // namespace

void append_frame(const Frame& f, std::vector<float>& out) {
  const std::size_t begin = out.size();
  const std::uint64_t high = f.tick / kTickSplit, low = f.tick % kTickSplit;
  append(out, static_cast<double>(high));
  append(out, static_cast<double>(low));
  append(out, std::floor(f.t));
  append(out, f.t - std::floor(f.t));
  for (const double v : f.x) append(out, v);
  for (const double v : f.y) append(out, v);
  for (const double v : f.wrench) append(out, v);
  append(out, f.gap);
  append(out, f.tick_us);
  append(out, f.servo_late_us);
  append(out, f.contacts);
  append(out, f.limits);
  append(out, f.flags);
  append(out, f.reason);
  append(out, static_cast<double>(f.pair_count));
  append(out, static_cast<double>(f.generation));
  append(out, static_cast<double>(f.force_count));
  static_assert(kFrameFloats == 4 + 7 + 7 + 6 + 10);
  out.resize(begin + kFrameFloats);
}

void append_pairs(const Frame& frame, std::vector<float>& out) {
  for (std::size_t i = 0; i < std::min<std::size_t>(frame.pair_count, kMaxPairs); ++i) {
    const FramePair& p = frame.pairs[i];
    for (const double v : p.point) append(out, v);
    for (const double v : p.normal) append(out, v);
    append(out, p.gap);
    append(out, 2.0 * (kFeaturePairs * p.part + p.features) + p.touching);
  }
}

void append_forces(const Frame& frame, std::vector<float>& out) {
  for (std::size_t i = 0; i < std::min<std::size_t>(frame.force_count, frame.forces.size()); ++i) {
    const FrameForce& c = frame.forces[i];
    for (const double v : c.point) append(out, v);
    for (const double v : c.normal) append(out, v);
    for (const double v : c.friction) append(out, v);
    append(out, c.mu);
    append(out, static_cast<double>(c.slides));
  }
}

std::string frame_message(const Frame& frame) {
  std::vector<float> values;
  values.reserve(kFrameFloats + kPairFloats * kMaxPairs + kForceFloats * ContactForces::kMax);
  append_frame(frame, values);
  append_pairs(frame, values);
  append_forces(frame, values);
  return message(Message::frame, values.data(), values.size() * sizeof(float));
}

std::string status_message(std::string_view json) {
  return message(Message::status, json.data(), json.size());
}

nlohmann::json parse_command(std::string_view text) {
  const auto shallow = [](int depth, nlohmann::json::parse_event_t, nlohmann::json&) {
    if (depth > kMaxDepth) throw Error("a command is nested too deeply");
    return true;
  };
  return nlohmann::json::parse(text, shallow);
}

}  // namespace tegotae::view
