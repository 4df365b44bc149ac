#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "shared/guarded_main.hpp"
#include "tegotae/session/session.hpp"
#include "view/address.hpp"
#include "view/script_review.hpp"

namespace tegotae::view {
class Server;
}

namespace tegotae::apps {

/// How a page is shown.
struct PageOptions {
  std::string address;  ///< empty: the loopback, any free port
  bool no_browser = false;
};

/// What the user asked for, common to all programs that run a scene.
struct RunOptions {
  std::string device;    ///< empty: the scene's, in this process
  std::string resolver;  ///< empty: the scene's
  bool fast = false;
  double seconds = 0;  ///< 0: to the end of the script
  std::string record;
  std::string guide;  ///< path that the hand is pulled along; empty: none
  bool json = false;
  bool check_all = false;
  bool view = false;
  PageOptions page;
  view::ScriptReview review;  ///< for the page's reports on what the mouse did; empty: there are none
};

/// The options --view-address and --no-browser.
struct PageOptionNames {
  CLI::Option* address;
  CLI::Option* no_browser;
};
PageOptionNames add_page_options(CLI::App& app, PageOptions& options);

/// Where to serve the page; the default where no address was given. Throws Error.
view::Address page_address(const PageOptions& options);

/// Reports where the page is: on stdout, or on stderr where `quiet` keeps that for data. Where stdout is a terminal and
/// `quiet` is not set somebody is there: then it opens the desktop's browser, unless that is not wanted, and returns
/// true, so that a run waits for its page.
bool announce_page(const view::Server& server, const PageOptions& options, bool quiet = false);

void add_run_options(CLI::App& app, RunOptions& options);

/// The option --guide.
void add_guide_option(CLI::App& app, RunOptions& options);

/// Runs the scene with a progress line (on a terminal) and Ctrl-C ending the run with its recording kept, and reports.
/// `goal` says in a few words what the run is to do.
int run_and_report(SceneFile file, const RunOptions& options, const std::string& goal);

}  // namespace tegotae::apps
