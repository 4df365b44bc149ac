#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "shared/guarded_main.hpp"
#include "tegotae/session/session.hpp"
#include "view/address.hpp"

namespace tegotae::apps {

/// What the user asked for, common to all programs that run a scene.
struct RunOptions {
  std::string device;    ///< empty: the scene's, in this process
  std::string resolver;  ///< empty: the scene's
  bool fast = false;
  double seconds = 0;  ///< 0: to the end of the script
  std::string record;
  bool json = false;
  bool check_all = false;
  bool view = false;
  std::string view_address;  ///< empty: the loopback, any free port
};

/// The option --view-address.
CLI::Option* add_view_address(CLI::App& app, std::string& address);

/// Reads it; the default where it was not given. Throws Error.
view::Address view_address(const std::string& text);

/// Tells where the page is: on stdout, or on stderr where `quiet` keeps that for data.
void announce_page(const std::string& url, bool quiet = false);

void add_run_options(CLI::App& app, RunOptions& options);

/// Runs the scene with a progress line (on a terminal) and Ctrl-C ending the run with its recording kept, and reports.
/// `goal` says in a few words what the run is to do; `depth_offset` (m) is added to the depth.
int run_and_report(SceneFile file, const RunOptions& options, const std::string& goal, double depth_offset = 0);

}  // namespace tegotae::apps
