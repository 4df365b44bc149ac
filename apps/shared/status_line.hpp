#pragma once

#include <chrono>
#include <cstddef>
#include <string>

#include "tegotae/scene_file/scene_file.hpp"

namespace tegotae::apps {

/// A line on stderr that tells how far something has come, on a terminal only. Gone when the object is.
class StatusLine {
 public:
  StatusLine();
  ~StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  /// Shows `what` at once.
  void say(const std::string& what) const;
  /// `done` of `total` (0: not known); shown ten times a second at most.
  void show(const std::string& what, std::size_t done, std::size_t total);

 private:
  const bool terminal_;
  std::string last_what_;
  std::chrono::steady_clock::time_point next_;
};

/// Loads a scene with such a line.
SceneFile load_with_progress(const std::string& path, SceneOptions options = {});

/// What of a scene's meshes is not as their files say, a line each on stderr.
void print_notes(const Scene& scene);

}  // namespace tegotae::apps
