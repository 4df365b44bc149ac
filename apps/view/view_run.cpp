#include "view/view_run.hpp"

#include "tegotae/core/error.hpp"
#include "view/live_view.hpp"
#include "view/server.hpp"

namespace tegotae::view {
namespace {

// Without --seconds a viewed run is over when somebody ends it: eleven days.
constexpr double kForever = 1e6;

/// The parts where they are, another one in the hand, which rests where that part is.
SceneFile with_held(SceneFile file, std::size_t held, const Pose& X) {
  for (Part& part : file.scene.parts)
    if (part.held) part.pose = X;
  for (std::size_t i = 0; i < file.scene.parts.size(); ++i) file.scene.parts[i].held = i == held;
  file.script = StylusScript({{0, file.scene.parts[held].pose}});
  return file;
}

}  // namespace

RunSummary run_viewed(SceneFile file, RunSettings settings, const Address& address, std::atomic<bool>& stop,
                      const std::function<void(const std::string&)>& announce) {
  LiveView live(file, !settings.real_time, settings.record.empty(), settings.device.empty(), stop);
  Server server(address, live);
  announce(server.url());
  if (settings.seconds == 0) settings.seconds = kForever;
  settings.observer = &live;
  settings.on_start = [&live, told = settings.on_start](const RunStart& start) {
    live.started(start.parts);
    if (told) told(start);
  };
  SceneFile now = file;
  for (;;) {
    settings.guide = &live.guide();
    const RunSummary summary = run_session(now, settings);
    std::size_t held = 0;
    bool keep = false;
    if (!live.take_request(held, keep)) return summary;
    Pose X = now.script.pose(now.script.begin());
    live.pose(X);
    now = keep ? with_held(now, held, X) : file;
    live.show(now);
    stop = false;
  }
}

}  // namespace tegotae::view
