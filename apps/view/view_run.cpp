#include "view/view_run.hpp"

#include <chrono>
#include <iostream>
#include <thread>

#include "tegotae/core/error.hpp"
#include "view/live_view.hpp"
#include "view/server.hpp"

namespace tegotae::view {
namespace {

// Without --seconds a viewed run is over when somebody ends it: eleven days.
constexpr double kForever = 1e6;
// A browser that has to be started first takes seconds, and a person who copies an address some more.
constexpr auto kFirstPage = std::chrono::seconds(30);
constexpr auto kPoll = std::chrono::milliseconds(20);

/// Or its beginning would be over when the page comes.
void wait_for_page(const Server& server, const std::atomic<bool>& stop) {
  std::cout << "The run starts when the page is connected, or in " << kFirstPage.count() << " s" << std::endl;
  const auto end = std::chrono::steady_clock::now() + kFirstPage;
  while (!stop && !server.watched() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(kPoll);
  if (!stop)
    std::cout << (server.watched() ? "The page is connected" : "No page connected") << "; the run starts" << std::endl;
}

}  // namespace

std::optional<RunSummary> run_viewed(SceneFile& file, RunSettings settings, const Address& address,
                                     std::atomic<bool>& stop, const std::function<bool(const Server&)>& announce,
                                     const ScriptReview& review) {
  LiveView live(file, !settings.real_time, settings.record.empty(), settings.device.empty(), stop, review,
                settings.guide_path);
  Server server(address, live);
  const bool held = PageParts(file.scene).any_held();
  if (announce(server) && settings.real_time && held) wait_for_page(server, stop);
  if (settings.seconds == 0) settings.seconds = kForever;
  settings.observer = &live;
  settings.on_start = [&live, told = settings.on_start](const RunStart& start) {
    live.started(start.parts);
    if (told) told(start);
  };
  std::optional<RunSummary> last;
  while (std::optional<SceneFile> run = live.next()) {
    file = *std::move(run);
    settings.guide = &live.guide();
    settings.edits = &live.edits();
    try {
      last = run_session(file, settings);
    } catch (const std::exception& e) {
      if (!live.refused(e.what())) throw;
      if (settings.on_build) settings.on_build("", 0, 0);  // nothing is built any more
      continue;
    }
    if (!live.again()) break;
  }
  return last;
}

}  // namespace tegotae::view
