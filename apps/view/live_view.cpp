#include "view/live_view.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/whole_number.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/mesh/mass.hpp"
#include "tegotae/mesh/report.hpp"
#include "view/bundle.hpp"

namespace tegotae::view {

using nlohmann::json;

namespace {

// How often a held run looks whether it may go on.
constexpr auto kPausePoll = std::chrono::milliseconds(2);
// Most ticks that one command may ask for.
constexpr int kMostSteps = 10'000;
// A pen farther from the world's origin (m) is a mistake.
constexpr double kFarthest = 100;

std::size_t held_number(const Scene& scene) {
  const auto held = std::find_if(scene.parts.begin(), scene.parts.end(), [](const Part& p) { return p.held; });
  return static_cast<std::size_t>(held - scene.parts.begin());
}

Vec3 center_of(const Scene& scene) {
  const TriangleMesh& mesh = *scene.parts[held_number(scene)].mesh;
  return mass_properties(mesh, report(mesh).closed, scene.contact.density).center;
}

/// Why the force is off, by number.
json force_off_names() {
  json names = json::array();
  for (std::uint32_t i = 0; i < TEGOTAE_SHM_REASONS; ++i) names.push_back(to_string(static_cast<ForceOff>(i)));
  return names;
}

}  // namespace

struct LiveView::Run {
  Run(const SceneFile& file, std::shared_ptr<const std::string> bundle_in)
      : maker(file.scene),
        held(held_number(file.scene)),
        parts(file.scene.parts.size()),
        suspended(std::make_unique<std::atomic<bool>[]>(parts)),
        bundle(std::move(bundle_in)) {
    for (const Part& part : file.scene.parts) names.push_back(part.name);
  }
  FrameMaker maker;
  HandGuide guide;
  std::size_t held, parts;
  std::vector<std::string> names;                  // of the parts
  std::unique_ptr<std::atomic<bool>[]> suspended;  // the held part is not kept out of it
  int suspended_count = 0;                         // of the contact loop's thread
  std::shared_ptr<const std::string> bundle;
};

LiveView::LiveView(const SceneFile& file, bool virtual_time, bool restartable, bool led, std::atomic<bool>& stop)
    : virtual_time_(virtual_time), restartable_(restartable), led_(led), stop_(stop), paused_(virtual_time) {
  show(file);
}

LiveView::~LiveView() = default;

void LiveView::show(const SceneFile& file) {
  Bundle bundle;
  add_scene(bundle, file.scene, center_of(file.scene));
  const std::lock_guard<std::mutex> lock(mutex_);
  bundle.about["mode"] = "live";
  bundle.about["title"] = file.path;
  bundle.about["generation"] = ++generation_;
  bundle.about["virtual_time"] = virtual_time_;
  bundle.about["restartable"] = restartable_;
  bundle.about["led"] = led_;
  bundle.about["reasons"] = force_off_names();
  run_ = std::make_shared<Run>(file, std::make_shared<const std::string>(bundle.bytes()));
  looped_ = run_.get();
  paced_ns_ = 0;
}

const HandGuide& LiveView::guide() const {
  return looped_->guide;
}

bool LiveView::take_request(std::size_t& held, bool& keep) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!requested_) return false;
  requested_ = false;
  held = held_;
  keep = keep_;
  return true;
}

bool LiveView::pose(Pose& X) const {
  FrameRing::Cursor cursor = ring_.newest();
  std::uint64_t missed = 0;
  Frame frame;
  if (!ring_.read(cursor, frame, missed)) return false;
  X = {Quat(frame.x[3], frame.x[4], frame.x[5], frame.x[6]), Vec3(frame.x[0], frame.x[1], frame.x[2])};
  return true;
}

void LiveView::before_tick(double t) {
  while (paused_ && !stop_) {
    paced_ns_ = 0;
    std::int64_t steps = steps_;
    if (steps > 0 && steps_.compare_exchange_strong(steps, steps - 1)) return;
    std::this_thread::sleep_for(kPausePoll);
  }
  const double speed = speed_;
  const std::int64_t now = monotonic_ns();
  if (paced_ns_ == 0 || !std::isfinite(speed)) {
    paced_ns_ = now;
    paced_t_ = t;
    return;
  }
  // From tick to tick, so that another speed holds at once.
  const std::int64_t due = paced_ns_ + static_cast<std::int64_t>(1e9 * (t - paced_t_) / speed);
  if (due > now) std::this_thread::sleep_for(std::chrono::nanoseconds(due - now));
  paced_ns_ = std::max(due, now);
  paced_t_ = t;
}

void LiveView::started(const StartReport& start) noexcept {
  looped_->suspended_count = 0;
  for (const StartPair& pair : start.pairs) {
    const bool suspended = pair.state == PairState::suspended;
    looped_->suspended[pair.part] = suspended;
    looped_->suspended_count += suspended ? 1 : 0;
  }
}

void LiveView::after_tick(const TickView& tick) noexcept {
  if (tick.loop.report().suspended != looped_->suspended_count) started(tick.loop.start());
  looped_->maker.fill(tick, frame_);
  ring_.push(frame_);
}

std::shared_ptr<const std::string> LiveView::scene() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return run_->bundle;
}

std::string LiveView::status() const {
  const double speed = speed_;
  const std::lock_guard<std::mutex> lock(mutex_);
  json suspended = json::array();
  for (std::size_t i = 0; i < run_->parts; ++i)
    if (run_->suspended[i]) suspended.push_back(run_->names[i]);
  return json{{"generation", generation_},
              {"suspended", suspended},
              {"paused", paused_.load()},
              {"speed", std::isfinite(speed) ? json(speed) : json(nullptr)}}
      .dump();
}

void LiveView::command(const json& command) {
  const std::string what = command.at("do");
  if (what == "lead") return lead(command);
  if (what == "hold") return hold(command);
  if (what == "restart") return request(0, false);
  if (!virtual_time_) throw Error(json(what).dump() + " needs virtual time (--fast)");
  if (what == "pause") {
    paused_ = true;
  } else if (what == "play") {
    steps_ = 0;
    paused_ = false;
  } else if (what == "step") {
    paused_ = true;
    steps_ =
        std::min<std::int64_t>(steps_ + std::clamp(whole_number<int>(command.at("ticks")), 1, kMostSteps), kMostSteps);
  } else if (what == "speed") {
    const json& factor = command.at("factor");
    speed_ = factor.is_null() ? std::numeric_limits<double>::infinity() : std::clamp(factor.get<double>(), 0.01, 10.0);
  } else {
    throw Error("unknown command " + json(what).dump());
  }
}

void LiveView::lead(const json& command) {
  const json& values = command.at("pose");
  if (!values.is_array() || values.size() != 7) throw Error("a pose has seven numbers");
  double v[7];
  for (std::size_t i = 0; i < 7; ++i) {
    v[i] = values[i].get<double>();
    if (!(std::abs(v[i]) <= kFarthest)) throw Error("a pose is out of range");
  }
  const Quat q(v[3], v[4], v[5], v[6]);
  if (!(q.norm() > 0.5)) throw Error("a pose has no rotation");
  const std::lock_guard<std::mutex> lock(mutex_);
  run_->guide.lead({q.normalized(), Vec3(v[0], v[1], v[2])});
}

void LiveView::hold(const json& command) {
  const auto part = whole_number<std::int64_t>(command.at("part"));
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (part < 0 || static_cast<std::size_t>(part) >= run_->parts) throw Error("there is no such part");
    if (static_cast<std::size_t>(part) == run_->held) return;
  }
  request(static_cast<std::size_t>(part), true);
}

void LiveView::request(std::size_t held, bool keep) {
  if (!restartable_) throw Error("a run that is recorded cannot start anew");
  const std::lock_guard<std::mutex> lock(mutex_);
  requested_ = true;
  held_ = held;
  keep_ = keep;
  stop_ = true;
}

}  // namespace tegotae::view
