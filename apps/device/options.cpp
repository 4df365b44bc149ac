#include "device/options.hpp"
#include "shared/option_check.hpp"

namespace tegotae::apps {

namespace {
constexpr int kButtons = 32;
}

void add_device_options(CLI::App& app, DeviceOptions& o) {
  CLI::Option* type = app.add_option("--type", o.type, "The device: simulated, openhaptics, spacemouse or gamepad")
                          ->check(one_of({"simulated", "openhaptics", "spacemouse", "gamepad"}))
                          ->type_name("TYPE");
  app.add_option("--script", o.script, "Stylus script (CSV) of the simulated hand; begins when an application attaches")
      ->type_name("FILE");
  app.add_option("--pen", o.pen, "Name of the pen in the vendor's set-up (openhaptics; default: its default pen)")
      ->type_name("PEN");
  app.add_option("--name", o.name, "Name of the shared-memory segment, one for each device")
      ->capture_default_str()
      ->type_name("NAME");
  app.add_option("--rate", o.rate_hz, "Servo ticks a second")
      ->check(between(10.0, 4000.0))
      ->capture_default_str()
      ->type_name("HZ");
  app.add_option("--cpu", o.cpu, "Bind the servo to this CPU")->check(at_least(0))->type_name("N");
  app.add_flag("--enforce", o.enforce, "Refuse to run when the system does not grant real time");
  app.add_option("--clutch-button", o.clutch_button, "While this button (0, 1, ...) is pressed the part stays")
      ->check(between(0, kButtons - 1))
      ->type_name("N");
  app.add_option("--dead-man-button", o.dead_man_button, "Force only while this button is pressed")
      ->check(between(0, kButtons - 1))
      ->type_name("N");
  CLI::Option* status = app.add_flag("--status", o.status, "Print the state of a running device, and exit");
  app.add_flag("--json", o.json, "With --status: one line of JSON")->needs(status);
  status->excludes(type);
}

}  // namespace tegotae::apps
