#include "record/frame_messages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/whole_number.hpp"

namespace tegotae {

namespace {

using nlohmann::json;

// Poses are as foxglove.PoseInFrame describes them, so that viewers that know the name show them.
#define TEGOTAE_XYZ \
  R"({"type":"object","properties":{"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"}}})"
constexpr const char* kPoseSchema =
    R"({"title":"foxglove.PoseInFrame","type":"object","properties":{)"
    R"("timestamp":{"type":"object","title":"time","properties":{"sec":{"type":"integer"},"nsec":{"type":"integer"}}},)"
    R"("frame_id":{"type":"string"},"pose":{"type":"object","properties":{"position":)" TEGOTAE_XYZ
    R"(,"orientation":{"type":"object","properties":{"x":{"type":"number"},"y":{"type":"number"},)"
    R"("z":{"type":"number"},"w":{"type":"number"}}}}}}})";
constexpr const char* kWrenchSchema =
    R"({"title":"tegotae.Wrench","description":"on the pen, at the held part's center of mass, world; N and N*m",)"
    R"("type":"object","properties":{"force":)" TEGOTAE_XYZ R"(,"torque":)" TEGOTAE_XYZ "}}";
constexpr const char* kContactSchema =
    R"({"title":"tegotae.Contact","type":"object","properties":{"contacts":{"type":"integer"},)"
    R"("gap":{"type":["number","null"],"description":"smallest known gap, m; null when nothing is near"}}})";
constexpr const char* kTickSchema =
    R"({"title":"tegotae.Tick","type":"object","properties":{"tick":{"type":"integer"},)"
    R"("substep":{"type":"integer","description":"number of the certified sub-step in its tick"},)"
    R"("t":{"type":"number","description":"s since the start"},)"
    R"("tick_us":{"type":"number","description":"time the tick took; 0 in virtual time"},)"
    R"("lag_reason":{"type":"string","description":"why the part is not where the pen wants it",)"
    R"("enum":["none","contact","time","capacity","suspended"]}}})";
constexpr const char* kForcesSchema =
    R"({"title":"tegotae.ContactForces","description":"on the held part at the end of the tick, world",)"
    R"("type":"object","properties":{"forces":{"type":"array","items":{"type":"object","properties":{)"
    R"("part":{"type":"integer","description":"number among the fixed parts"},)"
    R"("point":)" TEGOTAE_XYZ R"(,"normal":)" TEGOTAE_XYZ
    R"(,"gap":{"type":"number"},"force":{"type":"number","description":"N along the normal"},)"
    R"("mu":{"type":"number","description":"coefficient of friction; this and the next two where it is not 0"},)"
    R"("friction":)" TEGOTAE_XYZ R"(,"slides":{"type":"boolean"}}}},)"
    R"("lag":{"type":"object","description":"what the springs pull beyond the contacts; N and N*m",)"
    R"("properties":{"force":)" TEGOTAE_XYZ R"(,"torque":)" TEGOTAE_XYZ "}}}}";
#undef TEGOTAE_XYZ

json xyz(const Vec3& v) {
  return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}};
}

/// JSON has no infinity and no NaN, and the library writes them as null.
double number(const json& j) {
  return j.is_null() ? std::numeric_limits<double>::quiet_NaN() : j.get<double>();
}
Vec3 vector(const json& j) {
  return {number(j.at("x")), number(j.at("y")), number(j.at("z"))};
}

/// Recordings of earlier versions do not tell.
LagReason lag_reason(const json& message) {
  const auto found = message.find("lag_reason");
  if (found == message.end()) return LagReason::none;
  const auto word = found->get<std::string>();
  for (int i = 0; i < kLagReasons; ++i)
    if (word == to_string(static_cast<LagReason>(i))) return static_cast<LagReason>(i);
  throw json::type_error::create(302, "lag_reason: \"" + word + "\" is not a lag reason", &message);
}

json pose_message(const RecordFrame& frame, const Pose& X) {
  constexpr std::uint64_t second = 1'000'000'000;
  const std::uint64_t time = log_time(frame);
  json orientation = xyz(X.q.vec());
  orientation["w"] = X.q.w();
  return {{"timestamp", {{"sec", time / second}, {"nsec", time % second}}},
          {"frame_id", "world"},
          {"pose", {{"position", xyz(X.p)}, {"orientation", std::move(orientation)}}}};
}

Pose pose(const json& message) {
  const json& X = message.at("pose");
  const json& q = X.at("orientation");
  const Vec3 v = vector(q);
  return {Quat(number(q.at("w")), v.x(), v.y(), v.z()), vector(X.at("position"))};
}

json wrench_message(const Wrench& w) {
  return {{"force", xyz(w.force)}, {"torque", xyz(w.torque)}};
}

Wrench wrench(const json& j) {
  return {vector(j.at("force")), vector(j.at("torque"))};
}

json forces_message(const ContactForces& forces) {
  json list = json::array();
  for (int i = 0; i < forces.count; ++i) {
    const ContactForce& c = forces.items[static_cast<std::size_t>(i)];
    list.push_back(
        {{"part", c.part.index}, {"point", xyz(c.point)}, {"normal", xyz(c.n)}, {"gap", c.gap}, {"force", c.force}});
    if (c.mu == 0) continue;
    list.back()["mu"] = c.mu;
    list.back()["friction"] = xyz(c.friction);
    list.back()["slides"] = c.slides;
  }
  return {{"forces", std::move(list)}, {"lag", wrench_message(forces.lag)}};
}

ContactForces forces(const json& message) {
  ContactForces out;
  for (const json& c : message.at("forces")) {
    if (out.count == ContactForces::kMax) break;
    ContactForce& f = out.items[static_cast<std::size_t>(out.count++)];
    f = {};
    f.part = PartId{whole_number<std::uint32_t>(c.at("part"))};
    f.point = vector(c.at("point"));
    f.n = vector(c.at("normal"));
    f.gap = number(c.at("gap"));
    f.force = number(c.at("force"));
    if (!c.contains("mu")) continue;
    f.mu = number(c.at("mu"));
    f.friction = vector(c.at("friction"));
    f.slides = c.at("slides").get<bool>();
  }
  out.lag = wrench(message.at("lag"));
  return out;
}

}  // namespace

const std::array<FrameTopic, kFrameTopics> kTopics = {{{"/tick", "tegotae.Tick", kTickSchema},
                                                       {"/pen", "foxglove.PoseInFrame", kPoseSchema},
                                                       {"/part", "foxglove.PoseInFrame", kPoseSchema},
                                                       {"/wrench", "tegotae.Wrench", kWrenchSchema},
                                                       {"/forces", "tegotae.ContactForces", kForcesSchema},
                                                       {"/contact", "tegotae.Contact", kContactSchema}}};

std::uint64_t log_time(const RecordFrame& frame) {
  constexpr double most = 9e9;  // s; the time of a frame is never near it, but the cast must be defined
  return static_cast<std::uint64_t>(1e9 * std::clamp(std::isnan(frame.t) ? 0.0 : frame.t, 0.0, most) + 0.5);
}

std::string message_text(const RecordFrame& f, std::size_t i) {
  switch (i) {
    case 0:
      return json{{"tick", f.tick},
                  {"substep", f.substep},
                  {"t", f.t},
                  {"tick_us", f.tick_us},
                  {"lag_reason", to_string(f.lag_reason)}}
          .dump();
    case 1:
      return pose_message(f, f.y).dump();
    case 2:
      return pose_message(f, f.x).dump();
    case 3:
      return wrench_message(f.wrench).dump();
    case kForcesTopic:
      return forces_message(f.forces).dump();
    default:
      return json{{"contacts", f.contacts}, {"gap", f.gap}}.dump();
  }
}

void take_message(const json& m, std::size_t i, RecordFrame& f) {
  switch (i) {
    case 0:
      f.tick = whole_number<std::uint64_t>(m.at("tick"));
      f.substep = whole_number<std::uint32_t>(m.at("substep"));
      f.t = number(m.at("t"));
      f.tick_us = number(m.at("tick_us"));
      f.lag_reason = lag_reason(m);
      return;
    case 1:
      f.y = pose(m);
      return;
    case 2:
      f.x = pose(m);
      return;
    case 3:
      f.wrench = wrench(m);
      return;
    case kForcesTopic:
      f.forces = forces(m);
      return;
    default:
      f.contacts = whole_number<int>(m.at("contacts"));
      f.gap = m.at("gap").is_null() ? std::numeric_limits<double>::infinity() : m.at("gap").get<double>();
  }
}

}  // namespace tegotae
