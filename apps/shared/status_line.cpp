#include "shared/status_line.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <iostream>

#include "loop/scene_parts.hpp"

namespace tegotae::apps {

namespace {

bool in_pipes = false;
std::chrono::duration<double> pipe_period(2);
std::atomic<std::chrono::steady_clock::duration> last_pipe_line{};

// On a terminal a line may change ten times a second, and one that stays is told again each second.
constexpr std::chrono::milliseconds kTerminalPeriod(100);
constexpr std::chrono::seconds kStays(1);
// What takes longer than this says for how long it has taken.
constexpr std::chrono::seconds kLong(2);
// How often it is looked whether a line is due.
constexpr std::chrono::duration<double> kPoll(0.2);

}  // namespace

void say_progress_in_pipes() {
  in_pipes = true;
  const char* asked = std::getenv("TEGOTAE_PROGRESS_SECONDS");
  if (const double seconds = asked != nullptr ? std::atof(asked) : 0; seconds > 0)
    pipe_period = std::chrono::duration<double>(seconds);
  last_pipe_line = std::chrono::steady_clock::now().time_since_epoch();
}

bool pipe_line_is_due() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  auto last = last_pipe_line.load();
  return now - last >= pipe_period && last_pipe_line.compare_exchange_strong(last, now);
}

bool progress_in_pipes() {
  return in_pipes;
}

void add_progress_option(CLI::App& command) {
  command.add_flag_callback("--progress", say_progress_in_pipes,
                            "Say on stderr what is under way, also into a pipe, every two seconds");
}

StatusLine::StatusLine(bool on_terminal) : terminal_(on_terminal && isatty(STDERR_FILENO) != 0) {}

StatusLine::~StatusLine() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
  }
  wake_.notify_one();
  thread_.join();
  text_.clear();
  if (terminal_) write();
}

/// With mutex_ held.
void StatusLine::write() {
  written_ = Clock::now();
  std::string line = text_;
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(written_ - since_);
  if (!line.empty() && seconds >= kLong) line += " (" + std::to_string(seconds.count()) + " s)";
  std::fprintf(stderr, terminal_ ? "\r\033[K%s" : "%s\n", line.c_str());
  std::fflush(stderr);
}

void StatusLine::repeat() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!wake_.wait_for(lock, terminal_ ? kPoll : std::min(kPoll, pipe_period), [this] { return ended_; }))
    if (!text_.empty() && (terminal_ ? Clock::now() >= written_ + kStays : pipe_line_is_due())) write();
}

void StatusLine::set(const std::string& what, const std::string& text, bool at_once) {
  if (!terminal_ && !in_pipes) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool other = what != what_;
  if (other) since_ = Clock::now();
  what_ = what;
  text_ = text;
  if (!thread_.joinable()) thread_ = std::thread([this] { repeat(); });
  if (terminal_ ? at_once || other || Clock::now() >= written_ + kTerminalPeriod : !text.empty() && pipe_line_is_due())
    write();
}

void StatusLine::say(const std::string& what) {
  set(what, what, true);
}

void StatusLine::show(const std::string& what, std::size_t done, std::size_t total) {
  set(what, total > 0 ? what + " " + std::to_string(done) + " / " + std::to_string(total) : what, false);
}

SceneFile load_with_progress(const std::string& path, SceneOptions options, bool on_terminal) {
  StatusLine status(on_terminal);
  options.progress = [&](std::size_t done, std::size_t total) { status.show("reading mesh files", done, total); };
  return load_scene(path, options);
}

void print_notes(const Scene& scene) {
  for (const std::string& note : notes_of(scene)) std::cerr << "tegotae: note: " << note << "\n";
}

}  // namespace tegotae::apps
