#include "shared/status_line.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>

#include "loop/scene_parts.hpp"

namespace tegotae::apps {

namespace {
bool in_pipes = false;
}

void say_progress_in_pipes() {
  in_pipes = true;
}

bool progress_in_pipes() {
  return in_pipes;
}

void add_progress_option(CLI::App& command) {
  command.add_flag_callback("--progress", say_progress_in_pipes,
                            "Say on stderr what is under way, also into a pipe, every two seconds");
}

// In a pipe the first line comes after two seconds too: what is short needs none.
StatusLine::StatusLine()
    : terminal_(isatty(STDERR_FILENO) != 0),
      next_(std::chrono::steady_clock::now() + (terminal_ ? std::chrono::seconds(0) : kPipePeriod)) {}

StatusLine::~StatusLine() {
  if (terminal_) write("");
}

void StatusLine::write(const std::string& what) {
  std::fprintf(stderr, terminal_ ? "\r\033[K%s" : "%s\n", what.c_str());
  std::fflush(stderr);
}

void StatusLine::say(const std::string& what) {
  if (!terminal_ && !in_pipes) return;
  const auto now = std::chrono::steady_clock::now();
  if (!terminal_ && now < next_) return;
  next_ = now + kPipePeriod;
  write(what);
}

void StatusLine::show(const std::string& what, std::size_t done, std::size_t total) {
  if (!terminal_ && !in_pipes) return;
  const auto now = std::chrono::steady_clock::now();
  if (now < next_ && (!terminal_ || what == last_what_)) return;
  last_what_ = what;
  next_ = now + (terminal_ ? std::chrono::steady_clock::duration(std::chrono::milliseconds(100)) : kPipePeriod);
  write(total > 0 ? what + " " + std::to_string(done) + " / " + std::to_string(total) : what);
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
