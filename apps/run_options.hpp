#pragma once

#include <CLI/CLI.hpp>
#include <atomic>
#include <functional>
#include <string>

#include "tegotae/sim/session.hpp"
#include "view/address.hpp"

namespace tegotae::apps {

/// Exit codes of every program.
inline constexpr int kDone = 0;
inline constexpr int kRunFailed = 1;
inline constexpr int kBadInput = 2;

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

/// From now on Ctrl-C, SIGTERM and the end of the terminal (SIGHUP, unless it is ignored) set the flag that this
/// returns, and end nothing themselves.
std::atomic<bool>& catch_interrupts();

/// The option --view-address.
CLI::Option* add_view_address(CLI::App& app, std::string& address);

/// Reads it; the default where it was not given. Throws Error.
view::Address view_address(const std::string& text);

/// Tells where the page is: on stdout, or on stderr where `quiet` keeps that for data.
void announce_page(const std::string& url, bool quiet = false);

void add_run_options(CLI::App& app, RunOptions& options);

/// Parses the command line, runs `body` and returns the exit code. Bad usage and Errors are one line on stderr and
/// kBadInput, and so is standard output that could not be written to its end.
int guarded_main(CLI::App& app, int argc, char** argv, const std::function<int()>& body);

/// Runs the scene with a progress line (on a terminal) and Ctrl-C ending the run with its recording kept, and reports.
/// `goal` says in a few words what the run is to do; `depth_offset` (m) is added to the depth.
int run_and_report(SceneFile file, const RunOptions& options, const std::string& goal, double depth_offset = 0);

}  // namespace tegotae::apps
