#pragma once

#include <CLI/CLI.hpp>
#include <atomic>
#include <functional>

namespace tegotae::apps {

/// Exit codes of every program.
inline constexpr int kDone = 0;
inline constexpr int kRunFailed = 1;
inline constexpr int kBadInput = 2;

/// From now on Ctrl-C, SIGTERM and the end of the terminal (SIGHUP, unless it is ignored) set the flag that this
/// returns, and end nothing themselves.
std::atomic<bool>& catch_interrupts();

/// Parses the command line, runs `body` and returns the exit code. Bad usage and Errors are one line on stderr and
/// kBadInput, and so is standard output that could not be written to its end.
int guarded_main(CLI::App& app, int argc, char** argv, const std::function<int()>& body);

}  // namespace tegotae::apps
