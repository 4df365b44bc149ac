// What run_session makes of the thread that calls it.
#include <sched.h>

#include <future>

#include "bodies.hpp"
#include "catch.hpp"
#include "tegotae/session/session.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

/// Asks the system for itself, in a thread that ends at once.
bool system_grants_fifo() {
  return std::async(std::launch::async,
                    [] {
                      sched_param lowest{};
                      lowest.sched_priority = 1;
                      return sched_setscheduler(0, SCHED_FIFO, &lowest) == 0;
                    })
      .get();
}

class NotesPolicy final : public RunObserver {
 public:
  int policy = -1;
  void before_tick(double) override {}
  void after_tick(const TickView&) noexcept override { policy = sched_getscheduler(0); }
};

}  // namespace

TEST_CASE("the contact loop runs in real time where the system grants it, and gives it back", "[sim]") {
  Scene scene;
  scene.parts.push_back({"floor", shared(box({0.4, 0.4, 0.02})), {Quat::Identity(), {0, 0, -0.01}}, false});
  scene.parts.push_back({"cube", shared(box({0.04, 0.04, 0.04})), {Quat::Identity(), {0, 0, 0.05}}, true});
  const SceneFile file{"", scene, {}, StylusScript({{0, scene.parts[1].pose}})};
  NotesPolicy notes;
  RunSettings settings;
  settings.observer = &notes;
  settings.seconds = 0.05;
  const int before = sched_getscheduler(0);
  settings.real_time = GENERATE(true, false);
  const RunSummary summary = run_session(file, settings);
  const bool raised = settings.real_time && system_grants_fifo();
  CHECK(notes.policy == (raised ? SCHED_FIFO : before));
  CHECK((settings.real_time && !raised) == (summary.missing_realtime.find("SCHED_FIFO") != std::string::npos));
  CHECK(sched_getscheduler(0) == before);
}
