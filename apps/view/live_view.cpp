#include "view/live_view.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/whole_number.hpp"
#include "loop/scene_parts.hpp"
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
// How often who waits for a part to be held, or put down, looks whether the program ends.
constexpr auto kEndPoll = std::chrono::milliseconds(20);
// Most ticks that one command may ask for.
constexpr int kMaxSteps = 10'000;
// A pen farther from the world's origin (m) is a mistake.
constexpr double kFarthest = 100;

/// Center of mass of the held part in its file frame; zero when nothing is held.
Vec3 held_center(const PageParts& parts, double density) {
  if (!parts.any_held()) return Vec3::Zero();
  const TriangleMesh& mesh = *parts.all()[parts.held()].mesh;
  return mass_properties(mesh, report(mesh).closed, density).center;
}

/// Why the force is off, by number.
json force_off_names() {
  json names = json::array();
  for (std::uint32_t i = 0; i < TEGOTAE_SHM_REASONS; ++i) names.push_back(to_string(static_cast<ForceOff>(i)));
  return names;
}

std::array<double, 7> words(const Pose& X) {
  return {X.p.x(), X.p.y(), X.p.z(), X.q.w(), X.q.x(), X.q.y(), X.q.z()};
}
Pose pose_of(const double* v) {
  return {Quat(v[3], v[4], v[5], v[6]), Vec3(v[0], v[1], v[2])};
}

}  // namespace

struct LiveView::Segment {
  Segment(const PageParts& parts, std::uint64_t generation_in)
      : generation(generation_in),
        numbers(parts.numbers()),
        maker(numbers),
        suspended(std::make_unique<std::atomic<bool>[]>(parts.all().size())) {}

  const std::uint64_t generation;
  const std::vector<std::uint32_t> numbers;  // of the scene's parts, as the page counts them
  FrameMaker maker;
  std::unique_ptr<std::atomic<bool>[]> suspended;  // of the page's parts: the held one is not kept out of it
  int suspended_count = 0;                         // of the contact loop's thread
};

LiveView::LiveView(const SceneFile& file, bool virtual_time, bool restartable, bool led, std::atomic<bool>& stop,
                   ScriptReview review, const std::string& guide)
    : file_(file),
      loose_(!PageParts(file.scene).any_held()),
      virtual_time_(virtual_time),
      restartable_(restartable),
      led_(led),
      stop_(stop),
      review_(std::move(review)),
      paused_(virtual_time),
      parts_(file.scene) {
  bundle_.about = {{"mode", "live"},
                   {"title", file.path},
                   {"virtual_time", virtual_time_},
                   {"restartable", restartable_},
                   {"loose", loose_},
                   {"up", to_string(file.up)},
                   {"led", led_},
                   {"reviewable", review_ != nullptr},
                   {"reasons", force_off_names()}};
  add_scene(bundle_, file.scene, Vec3::Zero());
  if (!loose_) add_script(bundle_, file.script);
  const std::lock_guard<std::mutex> lock(mutex_);
  show(PageParts(file_.scene));
  if (!guide.empty()) add_guide(bundle_, read_path(guide), center_);
}

LiveView::~LiveView() = default;

std::optional<SceneFile> LiveView::next() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!parts_.any_held()) {
    if (stop_) return std::nullopt;
    changed_.wait_for(lock, kEndPoll);
  }
  by_number_[0] = looped_ = segment_.get();
  paced_ns_ = 0;
  SceneFile file = file_;
  if (loose_) {
    file.scene.parts = parts_.in_scene();
    file.script = StylusScript({{0, parts_.all()[parts_.held()].pose}});
  }
  return file;
}

bool LiveView::refused(const std::string& why) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!loose_) return false;
  PageParts parts = parts_;
  parts.put_down(parts.all()[parts.held()].pose);
  show(std::move(parts));
  if (std::exchange(request_, Request::none) != Request::none) stop_ = false;  // what was to end has not begun
  if (start_ == Start::asked) start_ = Start::refused;
  refusal_ = why;
  changed_.notify_all();
  return true;
}

bool LiveView::again() {
  const std::lock_guard<std::mutex> lock(mutex_);
  const Request request = std::exchange(request_, Request::none);
  if (request == Request::none) return false;
  PageParts parts = request == Request::restart ? PageParts(file_.scene) : parts_;
  const bool ticked = frame_.generation == generation_;
  if (request == Request::put_down) parts.put_down(ticked ? pose_of(frame_.x) : parts.all()[parts.held()].pose);
  show(std::move(parts));
  stop_ = false;
  return true;
}

/// A session that is not yet, or none. With mutex_ held.
void LiveView::show(PageParts parts) {
  session_ = std::make_shared<Session>();
  auto segment = std::make_shared<Segment>(parts, generation_ + 1);
  show(std::move(parts), std::move(segment));
}

/// With mutex_ held.
void LiveView::show(PageParts parts, std::shared_ptr<Segment> segment) {
  if (generation_ == 0 || parts.held() != parts_.held()) center_ = held_center(parts, file_.scene.contact.density);
  parts_ = std::move(parts);
  segment_ = std::move(segment);
  bundle_.about["generation"] = generation_ = segment_->generation;
  bundle_.about["center"] = {center_.x(), center_.y(), center_.z()};
  for (std::size_t i = 0; i < parts_.all().size(); ++i) {
    const Part& part = parts_.all()[i];
    bundle_.about["parts"][i].update(
        {{"held", part.held}, {"pose", pose_json(part.pose)}, {"removed", parts_.removed(i)}});
  }
  bytes_.reset();
}

void LiveView::before_tick(double t) {
  while (paused_ && !stop_) {
    paced_ns_ = 0;
    std::int64_t steps = steps_;
    if (steps > 0 && steps_.compare_exchange_strong(steps, steps - 1)) return;
    std::this_thread::sleep_for(kPausePoll);
    if (changing_) return;  // it comes into force with a tick
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

void LiveView::started(const InitialContactReport& start) noexcept {
  note_suspended(start);
  const std::lock_guard<std::mutex> lock(mutex_);
  if (start_ == Start::asked) start_ = Start::begun;
  changed_.notify_all();
}

/// Of the contact loop's thread.
void LiveView::note_suspended(const InitialContactReport& start) noexcept {
  looped_->suspended_count = 0;
  for (const InitialContact& pair : start.pairs) {
    const bool suspended = pair.state == InitialContactState::filtered;
    looped_->suspended[looped_->numbers[pair.part]] = suspended;
    looped_->suspended_count += suspended ? 1 : 0;
  }
}

void LiveView::after_tick(const TickView& tick) noexcept {
  looped_ = by_number_[tick.segment % kSlots].load(std::memory_order_acquire);
  if (tick.loop.report().filtered != looped_->suspended_count) note_suspended(tick.loop.start());
  looped_->maker.fill(tick, frame_);
  frame_.generation = looped_->generation;
  ring_.push(frame_);
  const Pose &P = tick.pen.raw, &Y = tick.pen.state.pose;
  const Vec3& c = tick.loop.center();
  pen_.write({words(P), words(Y), {c.x(), c.y(), c.z()}, tick.pen.scale, looped_->generation});
}

std::shared_ptr<const std::string> LiveView::scene() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!bytes_) bytes_ = std::make_shared<const std::string>(bundle_.bytes());
  return bytes_;
}

std::string LiveView::parts() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const json& about = bundle_.about;
  return json{{"generation", about["generation"]}, {"center", about["center"]}, {"parts", about["parts"]}}.dump(
      -1, ' ', false, json::error_handler_t::replace);
}

std::string LiveView::status() const {
  const double speed = speed_;
  const std::lock_guard<std::mutex> lock(mutex_);
  json suspended = json::array();
  for (std::size_t i = 0; i < parts_.all().size(); ++i)
    if (segment_->suspended[i]) suspended.push_back(parts_.all()[i].name);
  return json{{"generation", generation_},
              {"suspended", suspended},
              {"paused", paused_.load()},
              {"speed", std::isfinite(speed) ? json(speed) : json(nullptr)}}
      .dump();
}

void LiveView::command(const json& command) {
  const std::string what = command.at("do");
  if (what == "lead") return lead(command);
  if (what == "restart") return restart();
  if (what == "put_down") return put_down();
  if (what == "hold" || what == "remove" || what == "add" || what == "move") return edit(command);
  if (!virtual_time_) throw Error(json(what).dump() + " needs virtual time (--fast)");
  if (what == "pause") {
    paused_ = true;
  } else if (what == "play") {
    steps_ = 0;
    paused_ = false;
  } else if (what == "step") {
    paused_ = true;
    steps_ =
        std::min<std::int64_t>(steps_ + std::clamp(whole_number<int>(command.at("ticks")), 1, kMaxSteps), kMaxSteps);
  } else if (what == "speed") {
    const json& factor = command.at("factor");
    speed_ = factor.is_null() ? std::numeric_limits<double>::infinity() : std::clamp(factor.get<double>(), 0.01, 10.0);
  } else {
    throw Error("unknown command " + json(what).dump());
  }
}

std::string LiveView::review(const std::string& script) {
  if (!review_ || script.empty()) return {};
  const std::lock_guard<std::mutex> one(reviewing_);
  SceneFile file = file_;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!parts_.any_held()) throw Error("nothing is held");
    file.scene.parts = parts_.in_scene();
    // The scene's script is of the part that the scene holds.
    const Part& held = parts_.all()[parts_.held()];
    if (loose_ || held.name != held_part(file_.scene).name) file.script = StylusScript({{0, held.pose}});
  }
  return review_(std::move(file), script);
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
  const Pose wanted = {q.normalized(), Vec3(v[0], v[1], v[2])};
  PenSpace space{};
  if (!pen_.read(space)) return;
  const Pose P = pose_of(space.raw.data()), Y = pose_of(space.Y.data());
  const Vec3 center(space.center.data());
  // The hand is where it would be if it had brought the part there: the mapping from pen to part is rigid, but for
  // scale.
  const Quat turned = (wanted.q * Y.q.conjugate() * P.q).normalized();
  const Vec3 at = P * center + (wanted * center - Y * center) / space.scale;
  const std::lock_guard<std::mutex> lock(mutex_);
  // What was meant for the part that was held before comes too late.
  if (space.generation != generation_) return;
  if (command.contains("generation") && whole_number<std::uint64_t>(command.at("generation")) != generation_) return;
  session_->guide.lead({turned, at - turned * center});
}

void LiveView::edit(const json& command) {
  const std::lock_guard<std::mutex> one(editing_);
  std::unique_lock<std::mutex> lock(mutex_);
  if (!parts_.any_held()) return edit_at_rest(command, lock);
  PageParts parts = parts_;
  const std::shared_ptr<Session> session = session_;
  const std::uint64_t generation = generation_ + 1;
  lock.unlock();
  parts.edit(command);
  auto segment = std::make_shared<Segment>(parts, generation);
  try {
    parts.place(session->edits.change(parts.in_scene(), [&](std::uint64_t number) {
      by_number_[number % kSlots].store(segment.get(), std::memory_order_release);
      changing_ = true;
    }));
  } catch (const std::exception& e) {
    changing_ = false;
    throw Error(std::string("Nothing was changed: ") + e.what());
  }
  changing_ = false;
  lock.lock();
  if (session == session_) show(std::move(parts), std::move(segment));
}

/// No session is in the way. Holding a part asks for one, and waits until it has begun.
void LiveView::edit_at_rest(const json& command, std::unique_lock<std::mutex>& lock) {
  PageParts parts = parts_;
  parts.edit(command);
  show(std::move(parts));
  if (!parts_.any_held()) return;
  start_ = Start::asked;
  changed_.notify_all();
  while (start_ == Start::asked && !stop_) changed_.wait_for(lock, kEndPoll);
  if (std::exchange(start_, Start::none) == Start::refused) throw Error("It cannot be held: " + refusal_);
}

/// The session ends, and what was held stays where it is.
void LiveView::put_down() {
  if (!loose_) throw Error("the scene holds a part; hold another one instead");
  const std::lock_guard<std::mutex> one(editing_);
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!parts_.any_held()) throw Error("nothing is held");
  request_ = Request::put_down;
  stop_ = true;
}

void LiveView::restart() {
  if (!restartable_) throw Error("a recorded run cannot restart");
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!parts_.any_held()) return show(PageParts(file_.scene));
  request_ = Request::restart;
  stop_ = true;
}

}  // namespace tegotae::view
