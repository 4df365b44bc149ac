#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <string>
#include <thread>

#include "tegotae/scene_file/scene_file.hpp"

namespace CLI {
class App;
}

namespace tegotae::apps {

/// Adds --progress to a command: what is under way is also written into pipes (say_progress_in_pipes).
void add_progress_option(CLI::App& command);

/// Lets this process report what is under way also where stderr is not a terminal: a line at most every two seconds, or
/// the seconds of TEGOTAE_PROGRESS_SECONDS in the environment.
/// Call it before there are other threads.
void say_progress_in_pipes();
/// Whether this process reports progress there.
bool progress_in_pipes();
/// Whether two seconds have passed since the last line in a pipe, or since the process began; then they begin anew. So
/// what is short says nothing, and many short things do.
bool pipe_line_is_due();

/// A progress line on stderr: on a terminal, where the destructor clears it, and after say_progress_in_pipes(). What
/// takes long is told again from a thread of its own, with the seconds that it has taken: nobody has to wait for the
/// next call. Do not fork while one lives.
class StatusLine {
 public:
  /// Without `on_terminal` for pipes alone.
  explicit StatusLine(bool on_terminal = true);
  ~StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  /// Shows `what`, on a terminal at once; nothing when it is empty.
  void say(const std::string& what);
  /// `done` of `total` (0: not known); shown ten times a second at most.
  void show(const std::string& what, std::size_t done, std::size_t total);

 private:
  using Clock = std::chrono::steady_clock;

  void set(const std::string& what, const std::string& text, bool at_once);
  void repeat();
  void write();

  const bool terminal_;
  std::mutex mutex_;  // of what follows
  std::condition_variable wake_;
  bool ended_ = false;
  std::string what_, text_;
  Clock::time_point since_, written_;  // when `what_` began, and when a terminal last got a line
  std::thread thread_;
};

/// Loads a scene with such a line; without `on_terminal` for pipes alone.
SceneFile load_with_progress(const std::string& path, SceneOptions options = {}, bool on_terminal = true);

/// What of a scene's meshes is not as their files say, a line each on stderr.
void print_notes(const Scene& scene);

}  // namespace tegotae::apps
