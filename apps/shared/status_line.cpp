#include "shared/status_line.hpp"

#include <unistd.h>

#include <cstdio>
#include <iostream>

#include "loop/scene_parts.hpp"

namespace tegotae::apps {

StatusLine::StatusLine() : terminal_(isatty(STDERR_FILENO) != 0) {}

StatusLine::~StatusLine() {
  say("");
}

void StatusLine::say(const std::string& what) const {
  if (!terminal_) return;
  std::fprintf(stderr, "\r\033[K%s", what.c_str());
  std::fflush(stderr);
}

void StatusLine::show(const std::string& what, std::size_t done, std::size_t total) {
  const auto now = std::chrono::steady_clock::now();
  if (!terminal_ || (what == last_what_ && now < next_)) return;
  last_what_ = what;
  next_ = now + std::chrono::milliseconds(100);
  say(total > 0 ? what + " " + std::to_string(done) + " / " + std::to_string(total) : what);
}

SceneFile load_with_progress(const std::string& path, SceneOptions options) {
  StatusLine status;
  options.progress = [&](std::size_t done, std::size_t total) { status.show("reading mesh files", done, total); };
  return load_scene(path, options);
}

void print_notes(const Scene& scene) {
  for (const std::string& note : notes_of(scene)) std::cerr << "tegotae: note: " << note << "\n";
}

}  // namespace tegotae::apps
