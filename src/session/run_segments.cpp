#include "session/run_segments.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <thread>

#include "core/output_file.hpp"
#include "core/same_file.hpp"
#include "loop/scene_parts.hpp"
#include "scene_file/scene_text.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

namespace fs = std::filesystem;

// How long a change waits until the held part can go over to it.
constexpr std::chrono::seconds kPatience(1);
constexpr std::chrono::milliseconds kPoll(1);

std::string names_of_filtered(const InitialContactReport& start, const Scene& scene) {
  std::string names;
  for (const InitialContact& pair : start.pairs)
    if (pair.state == InitialContactState::filtered) names += (names.empty() ? "" : ", ") + scene.parts[pair.part].name;
  return names;
}

/// `path` with a number before its extension, and perhaps with another one.
fs::path numbered(const fs::path& path, std::uint64_t number, const fs::path& extension) {
  return path.parent_path() / (path.stem().string() + "." + std::to_string(number) + extension.string());
}

void remove_files(const RunSegment& segment) noexcept {
  std::error_code absent;
  for (const std::string& path : {segment.recording, recording_info_path(segment.recording), segment.scene_file})
    fs::remove(path, absent);
}

}  // namespace

Scene in_its_time(Scene scene, bool real_time) {
  if (!real_time) scene.contact.tick_budget = std::numeric_limits<double>::infinity();
  return scene;
}

RunSegments::RunSegments(const SceneFile& file, const RunSettings& settings, HapticLoop& loop, RunCheck& check,
                         const RunGoal& goal)
    : file_(file), settings_(settings), loop_(loop), check_(check), goal_(goal) {
  auto first = std::make_unique<RunSegment>();
  begin(*first, file.scene, loop.start());
  now_ = first.get();
  by_change_[0] = now_;
  now_->start = loop.start();
  now_->waiting = loop.report().filtered + loop.report().shrunk;
  if (!settings.record.empty()) record(*now_, now_->start);
  check_.watch(*first->check);
  segments_.push_back(std::move(first));
  if (settings.edits == nullptr) return;
  RunEdits::State& edits = settings.edits->state();
  const std::lock_guard<std::mutex> lock(edits.mutex);
  edits.run = this;
}

RunSegments::~RunSegments() {
  detach();
  check_.abandon();
}

void RunSegments::detach() {
  over_ = true;
  if (settings_.edits == nullptr) return;
  RunEdits::State& edits = settings_.edits->state();
  const std::lock_guard<std::mutex> lock(edits.mutex);
  if (edits.run == this) edits.run = nullptr;
}

void RunSegments::begin(RunSegment& segment, const Scene& scene, const InitialContactReport& start) {
  segment.number = segments_.size();
  segment.scene = scene;
  segment.held = held_part(scene).name;
  segment.start.pairs.reserve(scene.parts.size());  // follow() must not allocate
  segment.check = check_.segment(segment.scene, start);
}

void RunSegments::record(RunSegment& segment, const InitialContactReport& start) {
  RecordingInfo info{file_.path, segment.held, to_string(file_.scene.contact.resolver), settings_.program,
                     names_of_filtered(start, segment.scene)};
  info.guide = settings_.guide_path;
  name_goal(segment, info);
  segment.recording = settings_.record;
  if (segment.number > 0) {
    const fs::path first = settings_.record;
    if (!fs::is_regular_file(first))
      throw Error(ErrorKind::file,
                  settings_.record + ": is not a regular file; a changed scene needs a recording beside it",
                  {settings_.record, 0, {}, {}});
    segment.recording = numbered(first, segment.number + 1, first.extension()).string();
    segment.scene_file = numbered(first, segment.number + 1, ".toml").string();
    info.scene = fs::path(segment.scene_file).filename().string();
    info.continues = fs::path(segments_.back()->recording).filename().string();
  }
  refuse_to_replace({segment.recording, recording_info_path(segment.recording), segment.scene_file}, file_.files);
  if (segment.number > 0)
    write_file(segment.scene_file, scene_text(file_, segment.scene, fs::path(settings_.record).parent_path().string()));
  try {
    segment.recorder.emplace(segment.recording, settings_.real_time ? RecordMode::threaded : RecordMode::synchronous,
                             info);
  } catch (const Error&) {
    if (segment.number > 0) fs::remove(segment.scene_file);
    throw;
  }
}

/// What the run is judged by, so that whoever reads the recording need not have its script.
void RunSegments::name_goal(const RunSegment& segment, RecordingInfo& info) const {
  if (!(script_length(file_) > 0) || segment.held != held_part(file_.scene).name) return;
  info.goal = goal_text(goal_.end());
  info.goal_tolerance = exact_text(goal_.tolerance());
  // A person who leads the pen or the script's hand ends where they like.
  if (!settings_.device.empty() || settings_.guide != nullptr) return;
  info.judged_after = exact_text(follows_script(settings_) ? script_length(file_) : 0);
}

bool RunSegments::follow() noexcept {
  const std::uint64_t change = loop_.change_in_force();
  bool another = false;
  if (change != change_) {
    change_ = change;
    now_ = by_change_[change % kSlots].load(std::memory_order_acquire);
    now_->start = loop_.start();
    now_->waiting = static_cast<int>(std::count_if(now_->start.pairs.begin(), now_->start.pairs.end(),
                                                   [](const InitialContact& pair) { return pair.freed != 0; }));
    another = true;
  }
  const int freed = now_->waiting - loop_.report().filtered - loop_.report().shrunk;
  if (freed != now_->freed) now_->start = loop_.start();
  if (freed != now_->freed || another) now_->check->came_free(now_->start);
  now_->freed = freed;
  if (another) followed_.store(change, std::memory_order_release);
  return another;
}

bool RunSegments::wait_for(std::uint64_t change) const {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (followed_.load(std::memory_order_acquire) != change) {
    if (over_ || std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(kPoll);
  }
  return true;
}

std::vector<Part> RunSegments::change(std::vector<Part> parts, const std::function<void(std::uint64_t)>& ready) {
  RunSegment& before = *segments_.back();
  Scene scene = before.scene;
  scene.parts = std::move(parts);
  for (Part& part : scene.parts)
    if (part.name == before.held) part.pose = loop_.latest();
  auto made = std::make_unique<RunSegment>();
  RunSegment& segment = *made;
  SceneChange handle = loop_.change(in_its_time(scene, settings_.real_time),
                                    [&](std::uint64_t number, const InitialContactReport& start) {
                                      begin(segment, scene, start);
                                      if (!settings_.record.empty()) record(segment, start);
                                      by_change_[number % kSlots].store(&segment, std::memory_order_release);
                                      if (ready) ready(segment.number);
                                    });
  const std::uint64_t change = handle.number();
  if (!wait_for(change) && handle.cancel()) {
    segment.recorder.reset();
    if (!segment.recording.empty()) remove_files(segment);
    if (over_) throw Error("the run has ended");
    throw Error("what was added or moved blocks the held part's path, or there is no pen; try again");
  }
  // What could not be taken back is in force, and followed in the same tick.
  while (followed_.load(std::memory_order_acquire) != change) std::this_thread::sleep_for(kPoll);
  check_.watch(*segment.check);
  segments_.push_back(std::move(made));
  finish(before, fs::path(segment.recording).filename().string());
  return segment.scene.parts;
}

void RunSegments::finish(RunSegment& segment, const std::string& continued_by) noexcept {
  if (!segment.recorder) return;
  try {
    segment.recorder->close(continued_by);
  } catch (const Error& e) {
    if (failure_.empty()) failure_ = e.what();
  }
}

void RunSegments::end() {
  detach();
  for (const auto& segment : segments_) finish(*segment, {});
}

std::uint64_t RunSegments::dropped() const {
  std::uint64_t count = 0;
  for (const auto& s : segments_) count += s->recorder ? s->recorder->dropped() : 0;
  return count;
}

std::vector<std::string> RunSegments::recordings() const {
  std::vector<std::string> paths;
  for (const auto& s : segments_)
    if (!s->recording.empty()) paths.push_back(s->recording);
  return paths;
}

RunEdits::RunEdits() : state_(std::make_unique<State>()) {}
RunEdits::~RunEdits() = default;

std::vector<Part> RunEdits::change(std::vector<Part> parts, const std::function<void(std::uint64_t segment)>& ready) {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  if (state_->run == nullptr) throw Error("the run has not begun, or is over");
  return state_->run->change(std::move(parts), ready);
}

}  // namespace tegotae
