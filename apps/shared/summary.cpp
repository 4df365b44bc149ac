#include "shared/summary.hpp"

#include "core/number_text.hpp"
#include "shared/blocked_text.hpp"
#include "shared/format.hpp"
#include "shared/latency_json.hpp"
#include "shared/start_text.hpp"

namespace tegotae::apps {

namespace {

std::string row(const char* what, const LatencySummary& us) {
  return format("  %-12s median %.0f us, 99 %% %.0f us, 99.9 %% %.0f us, longest %.0f us\n", what, us.p50, us.p99,
                us.p999, us.max);
}

/// Why the force went off, and how often. That it waited for an application and for a small force comes at every start.
std::string force_off_lines(const ServoStatistics& servo) {
  std::string text;
  for (std::size_t i = 0; i < servo.force_off.size(); ++i) {
    const auto reason = static_cast<ForceOff>(i);
    if (servo.force_off[i] == 0 || reason == ForceOff::software || reason == ForceOff::engage) continue;
    text += format("  %-12s %llu times: %s\n", "force off", static_cast<unsigned long long>(servo.force_off[i]),
                   to_string(reason));
  }
  return text;
}

/// Why the part lagged, and how often. Contact is what a run is for. Virtual time ends no tick: there a part may still
/// be on its way when the tick's motions are made, as one that has slipped off an edge.
std::string lag_lines(const LagSummary& lag, bool virtual_time) {
  std::string text;
  const auto line = [&text](LagReason reason, std::int64_t ticks, const char* what) {
    if (ticks > 0)
      text += format("  %-12s %lld %s for %s: %s\n", "held back", static_cast<long long>(ticks),
                     ticks == 1 ? "tick" : "ticks", to_string(reason), what);
  };
  const auto ticks = [&lag](LagReason reason) { return lag.ticks[static_cast<std::size_t>(reason)]; };
  const std::int64_t short_of_time = ticks(LagReason::time);
  if (virtual_time && short_of_time > 0)
    text += format("  %-12s %lld %s: the motions of one ended before the part was there, and the next went on\n",
                   "held back", static_cast<long long>(short_of_time), short_of_time == 1 ? "tick" : "ticks");
  else
    line(LagReason::time, short_of_time, "the tick ended before the part was there");
  line(LagReason::capacity, ticks(LagReason::capacity), "no motion could be proved free");
  line(LagReason::suspended, ticks(LagReason::suspended), "the loop did not follow the pen");
  if (lag.unexplained > 0)
    text += format("  %-12s %lld ticks held back for long without a contact (docs/limits.md)\n", "UNEXPLAINED",
                   static_cast<long long>(lag.unexplained));
  return text;
}

}  // namespace

std::string json_line(const RunSummary& s, const SceneFile& file, const Blocker& blocker) {
  nlohmann::ordered_json j;
  j["scene"] = file.path;
  j["resolver"] = to_string(file.scene.contact.resolver);
  j["ticks"] = s.ticks;
  j["seconds"] = s.seconds;
  j["completed"] = s.completed;
  j["depth_m"] = s.depth_m;
  j["contacts_max"] = s.contacts_max;
  nlohmann::ordered_json lag = {{"max_m", s.lag.max_m}, {"unexplained_ticks", s.lag.unexplained}};
  for (int i = 1; i < kLagReasons; ++i)
    lag["ticks"][to_string(static_cast<LagReason>(i))] = s.lag.ticks[static_cast<std::size_t>(i)];
  j["lag"] = lag;
  j["penetrating"] = s.penetrating;
  j["checked"] = s.checked;
  j["poses"] = s.poses;
  j["deepest_m"] = s.deepest_m;
  j["start"] = start_json(s.start, file.scene);
  const Vec3& at = blocker.place_W;
  j["blocked_by"] = {{"part", blocker.part}, {"place_m", {at.x(), at.y(), at.z()}}};
  j["held_fast"] = held_fast_json(s, file.scene);
  j["tick_us"] = to_json(s.tick_us);
  j["servo"] = {{"rate_hz", s.servo.rate_hz},
                {"late_us", to_json(s.servo.late_us)},
                {"missed", s.servo.missed},
                {"compute_us", to_json(s.servo.compute_us)},
                {"force_off", s.servo.force_off}};
  j["recordings"] = s.recordings;
  j["record_dropped"] = s.record_dropped;
  j["record_failure"] = s.record_failure;
  j["device_losses"] = s.device_losses;
  j["ignored"] = s.ignored;
  j["force_max_n"] = s.force_max_n;
  j["torque_max_nm"] = s.torque_max_nm;
  return j.dump();
}

std::string summary_text(const RunSummary& s, const RunOptions& options, const SceneFile& file, const std::string& goal,
                         const Blocker& blocker, bool interrupted) {
  const bool intersects = s.penetrating > 0 && file.scene.contact.resolver != ResolverKind::penalty;
  const bool led = !options.device.empty() || options.view;  // by a person, who ends where they like
  const std::string verdict = intersects            ? "FAILED: poses intersect another part"
                              : s.completed         ? "done"
                              : led                 ? "ended"
                              : interrupted         ? "interrupted"
                              : options.seconds > 0 ? "cut short"
                                                    : "FAILED: " + blocked_text(blocker);
  std::string text = goal + ": " + verdict + "\n";
  text += format("  %-12s ", "depth") + fixed_text(1e3 * s.depth_m, 1) + " mm\n";
  text += format("  %-12s at most %d at once\n", "contacts", s.contacts_max);
  text += lag_lines(s.lag, options.fast);
  text += format(
      "  %-12s %lld of %lld poses checked%s\n", "intersecting", static_cast<long long>(s.penetrating),
      static_cast<long long>(s.checked),
      s.checked < s.poses ? format(" (of %lld; --check-all checks all)", static_cast<long long>(s.poses)).c_str() : "");
  text += start_text(s.start, file.scene);
  text += held_fast_text(s, file.scene);
  if (file.scene.contact.resolver == ResolverKind::penalty)
    text += format("  %-12s interpenetration is allowed; deepest vertex %.1f um\n", "penalty:", 1e6 * s.deepest_m);
  text += format("  %-12s %.2f N, %.0f mN m\n", "at most", s.force_max_n, 1e3 * s.torque_max_nm);
  text += row("tick", s.tick_us);
  if (options.fast) {
    text += format("  %-12s %.1f s in virtual time\n", "time", s.seconds);
  } else {
    text += row("servo late", s.servo.late_us);
    text += format("  %-12s %.1f s, servo at %.1f Hz, %lld ticks missed\n", "time", s.seconds, s.servo.rate_hz,
                   static_cast<long long>(s.servo.missed));
  }
  if (!options.fast && !s.missing_realtime.empty())
    text += format("  %-12s ", "real time") + "not granted: " + s.missing_realtime + "\n";
  text += force_off_lines(s.servo);
  if (s.device_losses > 0)
    text += format("  %-12s lost %llu times; the part stayed where it was\n", "device",
                   static_cast<unsigned long long>(s.device_losses));
  if (s.ignored > 0)
    text += format("  %-12s %lld ticks had an invalid pen pose or time; the last valid pose replaced it\n", "ignored",
                   static_cast<long long>(s.ignored));
  if (s.record_dropped > 0)
    text += format("  %-12s %llu rows were dropped: the disk could not keep up\n", "recording",
                   static_cast<unsigned long long>(s.record_dropped));
  for (const std::string& path : s.recordings) text += format("  %-12s ", "recording") + path + "\n";
  return text;
}

}  // namespace tegotae::apps
