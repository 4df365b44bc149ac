#include "device/status.hpp"

#include <iostream>
#include <nlohmann/json.hpp>

#include "core/number_text.hpp"
#include "shared/format.hpp"
#include "shared/guarded_main.hpp"
#include "shared/latency_json.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/device/device.hpp"
#include "tegotae/transport/channel.hpp"

namespace tegotae::apps {

namespace {

using nlohmann::ordered_json;

// An application or a servo whose heartbeat is older is gone.
constexpr double kAliveSeconds = 0.5;

struct Status {
  std::string name;
  std::uint64_t pid = 0;
  double uptime = 0;          // s
  double heartbeat_age = -1;  // s of the servo; negative: no tick yet
  bool application = false;   // one is attached and alive
  tegotae_shm_device pen{};
  tegotae_shm_statistics statistics{};
};

double seconds_since(std::int64_t then_ns) {
  return 1e-9 * static_cast<double>(monotonic_ns() - then_ns);
}

Status look(const std::string& name) {
  const ChannelReader channel = ChannelReader::open(name);
  Status s;
  s.name = channel.name();
  s.pid = channel.owner_pid();
  s.uptime = seconds_since(channel.created_ns());
  if (channel.read(s.pen)) s.heartbeat_age = seconds_since(s.pen.heartbeat_ns);
  tegotae_shm_application application;
  s.application = channel.read(application) && seconds_since(application.heartbeat_ns) < kAliveSeconds;
  channel.read(s.statistics);
  s.pen.name[TEGOTAE_SHM_NAME - 1] = '\0';
  return s;
}

std::string realtime_text(const tegotae_shm_statistics& s) {
  std::string text;
  const auto add = [&](std::uint32_t bit, const std::string& what) {
    if ((s.realtime & bit) != 0) text += (text.empty() ? "" : ", ") + what;
  };
  add(TEGOTAE_SHM_REALTIME_FIFO, "SCHED_FIFO");
  add(TEGOTAE_SHM_REALTIME_MEMORY, "memory locked");
  add(TEGOTAE_SHM_REALTIME_TIMER_SLACK, "timer slack");
  add(TEGOTAE_SHM_REALTIME_AFFINITY, "CPU " + std::to_string(s.cpu));
  return text.empty() ? "nothing granted" : text;
}

std::string row(const char* what, const double (&us)[4]) {
  return format("  %-12s median %.1f us, 99 %% %.1f us, 99.9 %% %.1f us, longest %.0f us\n", what, us[0], us[1], us[2],
                us[3]);
}

std::string text(const Status& s) {
  const tegotae_shm_device& pen = s.pen;
  std::string out = s.name + ": " +
                    (s.heartbeat_age < 0               ? "starting"
                     : s.heartbeat_age > kAliveSeconds ? format("the servo is silent for %.1f s", s.heartbeat_age)
                                                       : state_text(pen)) +
                    "\n";
  out += format("  %-12s %s, senses %u and renders %u degrees of freedom, at most %s N, %s mN m\n", "device", pen.name,
                pen.motion_freedom, pen.force_freedom, number_text(pen.force_limit, 3).c_str(),
                number_text(1e3 * pen.torque_limit, 3).c_str());
  out += format("  %-12s %llu, up %.1f s\n", "process", static_cast<unsigned long long>(s.pid), s.uptime);
  out += format("  %-12s %s\n", "application", s.application ? "attached" : "none");
  out += statistics_text(s.statistics);
  out += format("  %-12s ", "real time") + realtime_text(s.statistics) + "\n";
  return out;
}

LatencySummary percentiles(const double (&us)[4]) {
  return {us[0], us[1], us[2], us[3]};
}

ordered_json json(const Status& s) {
  const tegotae_shm_statistics& t = s.statistics;
  ordered_json j;
  j["name"] = s.name;
  j["device"] = s.pen.name;
  j["pid"] = s.pid;
  j["uptime_s"] = s.uptime;
  j["heartbeat_age_s"] = s.heartbeat_age < 0 ? ordered_json() : ordered_json(s.heartbeat_age);
  j["state"] = to_string(static_cast<DeviceStatus>(s.pen.status));
  j["reason"] = to_string(static_cast<ForceOff>(s.pen.reason));
  j["reason_code"] = s.pen.reason;
  j["application"] = s.application;
  j["set_rate_hz"] = t.set_rate_hz;
  j["rate_hz"] = t.rate_hz;
  j["ticks"] = t.ticks;
  j["missed"] = t.missed;
  j["late_us"] = to_json(percentiles(t.late_us));
  j["compute_us"] = to_json(percentiles(t.compute_us));
  j["realtime"] = {{"fifo", (t.realtime & TEGOTAE_SHM_REALTIME_FIFO) != 0},
                   {"memory", (t.realtime & TEGOTAE_SHM_REALTIME_MEMORY) != 0},
                   {"timer_slack", (t.realtime & TEGOTAE_SHM_REALTIME_TIMER_SLACK) != 0},
                   {"cpu", t.cpu}};
  j["force_off"] = ordered_json::object();
  for (std::uint32_t i = 0; i < TEGOTAE_SHM_REASONS; ++i)
    if (t.force_off[i] > 0) j["force_off"][to_string(static_cast<ForceOff>(i))] = t.force_off[i];
  return j;
}

}  // namespace

std::string state_text(const tegotae_shm_device& pen) {
  if (pen.reason == TEGOTAE_SHM_REASON_NONE) return "force on";
  return std::string("force off: ") + to_string(static_cast<ForceOff>(pen.reason));
}

std::string statistics_text(const tegotae_shm_statistics& s) {
  return format("  %-12s %.1f of %s Hz, %llu ticks, %llu missed\n", "servo", s.rate_hz,
                number_text(s.set_rate_hz, 6).c_str(), static_cast<unsigned long long>(s.ticks),
                static_cast<unsigned long long>(s.missed)) +
         row("late", s.late_us) + row("compute", s.compute_us);
}

int print_status(const std::string& name, bool as_json) {
  const Status status = look(name);
  if (as_json)
    std::cout << json(status).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << std::endl;
  else
    std::cout << text(status) << std::flush;
  return kDone;
}

}  // namespace tegotae::apps
