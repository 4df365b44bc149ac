#include "summary.hpp"

#include <cstdarg>
#include <cstdio>

#include "latency_json.hpp"

namespace tegotae::apps {

namespace {

std::string format(const char* pattern, ...) __attribute__((format(printf, 1, 2)));

std::string format(const char* pattern, ...) {
  char text[256];
  va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(text, sizeof text, pattern, arguments);
  va_end(arguments);
  return text;
}

std::string row(const char* what, const LatencySummary& us) {
  return format("  %-12s median %.0f us, 99 %% %.0f us, 99.9 %% %.0f us, longest %.0f us\n", what, us.p50, us.p99,
                us.p999, us.max);
}

}  // namespace

std::string json_line(const RunSummary& s, const SceneFile& file) {
  nlohmann::ordered_json j;
  j["scene"] = file.path;
  j["resolver"] = file.scene.contact.resolver;
  j["ticks"] = s.ticks;
  j["seconds"] = s.seconds;
  j["completed"] = s.completed;
  j["depth_m"] = s.depth_m;
  j["contacts_max"] = s.contacts_max;
  j["penetrating"] = s.penetrating;
  j["tick_us"] = to_json(s.tick_us);
  j["servo"] = {{"rate_hz", s.servo.rate_hz}, {"late_us", to_json(s.servo.late_us)}, {"missed", s.servo.missed}};
  j["force_max_n"] = s.force_max_n;
  j["torque_max_nm"] = s.torque_max_nm;
  return j.dump();
}

std::string summary_text(const RunSummary& s, const RunOptions& options, const std::string& goal, bool interrupted) {
  const char* verdict = s.completed           ? "done"
                        : interrupted         ? "interrupted"
                        : options.seconds > 0 ? "cut short"
                                              : "FAILED";
  std::string text = goal + ": " + verdict + "\n";
  text += format("  %-12s %.1f mm\n", "depth", 1e3 * s.depth_m);
  text += format("  %-12s at most %d at once\n", "contacts", s.contacts_max);
  text += format("  %-12s %lld of %lld ticks\n", "intersecting", static_cast<long long>(s.penetrating),
                 static_cast<long long>(s.ticks));
  text += format("  %-12s %.2f N, %.0f mN m\n", "at most", s.force_max_n, 1e3 * s.torque_max_nm);
  text += row("tick", s.tick_us);
  if (options.fast) {
    text += format("  %-12s %.1f s in virtual time\n", "time", s.seconds);
  } else {
    text += row("servo late", s.servo.late_us);
    text += format("  %-12s %.1f s, servo at %.1f Hz, %lld ticks missed\n", "time", s.seconds, s.servo.rate_hz,
                   static_cast<long long>(s.servo.missed));
  }
  if (!options.record.empty()) text += format("  %-12s ", "recording") + options.record + "\n";
  return text;
}

}  // namespace tegotae::apps
