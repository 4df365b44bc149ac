#include "shared/run_options.hpp"

#include <unistd.h>

#include <atomic>
#include <iostream>
#include <optional>

#include "shared/format.hpp"
#include "shared/open_browser.hpp"
#include "shared/progress_line.hpp"
#include "shared/start_text.hpp"
#include "shared/status_line.hpp"
#include "shared/summary.hpp"
#include "tegotae/core/version.hpp"
#include "view/server.hpp"
#include "view/view_run.hpp"

namespace tegotae::apps {

PageOptionNames add_page_options(CLI::App& app, PageOptions& options) {
  CLI::Option* address =
      app.add_option("--view-address", options.address, "Where to serve the page (127.0.0.1, any free port)")
          ->type_name("ADDRESS[:PORT]");
  return {address, app.add_flag("--no-browser", options.no_browser, "Only print the page's address")};
}

view::Address page_address(const PageOptions& options) {
  return options.address.empty() ? view::Address() : view::parse_address(options.address);
}

bool announce_page(const view::Server& server, const PageOptions& options, bool quiet) {
  (quiet ? std::cerr : std::cout) << "Open " << server.url() << " (Ctrl-C ends it)" << std::endl;
  if (const std::string warning = server.warning(); !warning.empty()) std::cerr << "warning: " << warning << std::endl;
  const bool somebody = !quiet && isatty(STDOUT_FILENO) != 0;
  if (somebody && !options.no_browser && open_in_browser(server.url_once()))
    std::cout << "Your browser opens it (--no-browser: it does not)" << std::endl;
  return somebody;
}

void add_guide_option(CLI::App& app, RunOptions& options) {
  app.add_option("--guide", options.guide,
                 "Pull the hand gently along a path, as `plan` writes it; it may leave the path at any time")
      ->type_name("PATH.csv");
}

void add_run_options(CLI::App& app, RunOptions& options) {
  app.add_option("--resolver", options.resolver,
                 "Contact resolver: qp or lp, or for comparison impulse or penalty; overrides the scene's")
      ->type_name("NAME");
  CLI::Option* device =
      app.add_option("--device", options.device, "shm:NAME: the pen of a running tegotae-device, until Ctrl-C")
          ->type_name("DEVICE");
  CLI::Option* fast =
      app.add_flag("--fast", options.fast, "Virtual time: as fast as it goes, the same recording on every run");
  fast->excludes(device);
  app.add_option("--record", options.record,
                 "Write every pose and wrench to a file: MCAP when it ends in .mcap, else CSV")
      ->type_name("FILE");
  app.add_flag(
      "--check-all", options.check_all,
      "Check every pose with FCL, however long it takes (default: as many as a quarter of the run's time allows)");
  app.add_flag("--json", options.json, "Print the summary as one line of JSON");
  auto* view = app.add_flag("--view", options.view, "Serve a page that shows the run, until Ctrl-C");
  const PageOptionNames page = add_page_options(app, options.page);
  page.address->needs(view);
  page.no_browser->needs(view);
}

namespace {

RunSettings settings_of(const RunOptions& options) {
  RunSettings settings;
  settings.device = options.device;
  settings.real_time = !options.fast;
  settings.seconds = options.seconds;
  settings.record = options.record;
  settings.guide_path = options.guide;
  settings.program = "tegotae " TEGOTAE_VERSION_STRING;
  settings.check_all = options.check_all;
  return settings;
}

}  // namespace

int run_and_report(SceneFile file, const RunOptions& options, const std::string& goal) {
  if (!options.resolver.empty()) file.scene.contact.resolver = resolver_kind(options.resolver);
  if (!options.guide.empty()) file.files.push_back(options.guide);  // a recording must not replace it
  RunSettings settings = settings_of(options);
  RunProgress progress;
  settings.progress = &progress;
  BlockerWatch watch;
  settings.observer = &watch;
  std::atomic<bool>& interrupted = catch_interrupts();
  settings.stop = settings.stop_check = &interrupted;
  std::optional<StatusLine> building;  // until the first tick; then the progress line tells
  settings.on_build = [&](const std::string& what, std::size_t done, std::size_t total) {
    if (!building) building.emplace(!options.json);
    building->show(what, done, total);
  };
  settings.on_start = [&](const RunStart& start) {
    building.reset();
    const std::string text = start_text(start.parts, file.scene);
    if (!text.empty()) std::cerr << "At the start the held part is\n" << text << std::flush;
    if (!options.json && !start.stability.empty())
      std::cout << format("%-12s ", "stability:") << start.stability << std::endl;
    if (!options.json) std::cout << format("%-12s ", "torsion:") << start.torsion << std::endl;
    if (!options.json && !start.weight.empty()) std::cout << format("%-12s ", "weight:") << start.weight << std::endl;
    if (!options.json && !start.guide.empty()) std::cout << format("%-12s ", "guide:") << start.guide << std::endl;
  };

  std::optional<RunSummary> run;
  {
    if (options.view) settings.on_build("preparing the page", 0, 0);
    ProgressLine line(progress, !options.json && !options.view);
    run = options.view ? view::run_viewed(
                             file, settings, page_address(options.page), interrupted,
                             [&](const view::Server& server) {
                               building.reset();
                               return announce_page(server, options.page, options.json);
                             },
                             options.review)
                       : run_session(file, settings);
  }
  if (!run) return kDone;  // the page was open and held no part
  const RunSummary& summary = *run;
  // None after a run with a page, which may have changed the scene. Looked for where it is told; Ctrl-C ends that.
  const Blocker blocker =
      options.json || !summary.completed ? watch.find(file.scene, summary.start, &interrupted) : Blocker();
  if (options.json)
    std::cout << json_line(summary, file, blocker) << std::endl;
  else
    std::cout << summary_text(summary, options, file, goal, blocker, interrupted.load()) << std::flush;
  // A run that was asked to be short is done when its time is over, one that was looked at or has another process's pen
  // whenever it ends.
  const bool done =
      summary.completed || options.view || !options.device.empty() || (options.seconds > 0 && !interrupted.load());
  if (!summary.record_failure.empty()) {
    std::cerr << "tegotae: " << summary.record_failure << "\n";
    return kBadInput;
  }
  const bool clean = summary.penetrating == 0 || file.scene.contact.resolver == ResolverKind::penalty;
  return done && clean ? kDone : kRunFailed;
}

}  // namespace tegotae::apps
