#pragma once

#include <chrono>
#include <cstddef>
#include <string>

#include "tegotae/scene_file/scene_file.hpp"

namespace CLI {
class App;
}

namespace tegotae::apps {

/// Adds --progress to a command: what is under way is also written into pipes (say_progress_in_pipes).
void add_progress_option(CLI::App& command);

/// Lets this process report what is under way also where stderr is no terminal: a line at most every two seconds.
/// Call it before there are other threads.
void say_progress_in_pipes();
/// Whether this process reports progress there.
bool progress_in_pipes();
constexpr std::chrono::seconds kPipePeriod(2);

/// A progress line on stderr: on a terminal, where the destructor clears it, and after say_progress_in_pipes().
class StatusLine {
 public:
  StatusLine();
  ~StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  /// Shows `what`, on a terminal at once.
  void say(const std::string& what);
  /// `done` of `total` (0: not known); shown ten times a second at most.
  void show(const std::string& what, std::size_t done, std::size_t total);

 private:
  void write(const std::string& what);

  const bool terminal_;
  std::string last_what_;
  std::chrono::steady_clock::time_point next_;
};

/// Loads a scene with such a line.
SceneFile load_with_progress(const std::string& path, SceneOptions options = {});

/// What of a scene's meshes is not as their files say, a line each on stderr.
void print_notes(const Scene& scene);

}  // namespace tegotae::apps
