#include "view/view_run.hpp"

#include <iostream>

#include "tegotae/core/error.hpp"
#include "view/live_view.hpp"
#include "view/server.hpp"

namespace tegotae::view {
namespace {

// Without --seconds a viewed run is over when somebody ends it: eleven days.
constexpr double kForever = 1e6;

}  // namespace

RunSummary run_viewed(const SceneFile& file, RunSettings settings, const Address& address, std::atomic<bool>& stop,
                      const std::function<void(const std::string&)>& announce) {
  LiveView live(file, !settings.real_time, settings.record.empty(), settings.device.empty(), stop);
  Server server(address, live);
  announce(server.url());
  if (const std::string warning = server.warning(); !warning.empty()) std::cerr << "warning: " << warning << std::endl;
  if (settings.seconds == 0) settings.seconds = kForever;
  settings.observer = &live;
  settings.on_start = [&live, told = settings.on_start](const RunStart& start) {
    live.started(start.parts);
    if (told) told(start);
  };
  for (;;) {
    settings.guide = &live.guide();
    settings.edits = &live.edits();
    const RunSummary summary = run_session(file, settings);
    if (!live.take_request()) return summary;
    live.begin();
    stop = false;
  }
}

}  // namespace tegotae::view
