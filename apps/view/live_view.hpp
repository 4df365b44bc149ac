#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "device/mailbox.hpp"
#include "tegotae/session/session.hpp"
#include "view/bundle.hpp"
#include "view/frame_maker.hpp"
#include "view/frame_ring.hpp"
#include "view/page_parts.hpp"
#include "view/script_review.hpp"
#include "view/source.hpp"

namespace tegotae::view {

/// A scene for the page, and the session in which one of its parts is held: shows its ticks, and takes the page's
/// commands. The loops meet the server's threads in a ring of frames, a hand guide, the session's edits and atomics
/// only.
///
/// A scene that holds no part is shown without a session. That begins when the page holds one, and ends when the page
/// puts it down.
class LiveView final : public RunObserver, public ViewSource {
 public:
  /// `stop` ends the session (RunSettings::stop); commands that need another session set it. Keeps references.
  /// `restartable`: whether the page may ask for that; `led`: whether the session's hand follows guide().
  /// `review` makes reports for review(), in a thread of the server; empty: there are none. `guide`: path (CSV) that is
  /// drawn, of the scene's held part; empty: none. Throws Error when that cannot be read.
  LiveView(const SceneFile& file, bool virtual_time, bool restartable, bool led, std::atomic<bool>& stop,
           ScriptReview review = {}, const std::string& guide = {});
  ~LiveView() override;

  // For the thread that runs the sessions.

  /// Waits until a part is held. Returns the scene for the next session; nothing when `stop` is set before.
  std::optional<SceneFile> next();
  /// The session of next() could not begin. Returns whether the page asked for it: then the page gets `why`, and no
  /// part is held.
  bool refused(const std::string& why);
  /// That session is over. Whether the page asked for what follows: the scene anew, or with the part put down.
  bool again();
  /// What leads the hand in the session now.
  const InputGuide& guide() const { return session_->guide; }
  /// What changes its scene.
  RunEdits& edits() const { return session_->edits; }
  /// The session begins, and the held part starts like this; which pairs are suspended goes to the page.
  void started(const InitialContactReport& start) noexcept;

  void before_tick(double t) override;
  void after_tick(const TickView& tick) noexcept override;

  std::shared_ptr<const std::string> scene() const override;
  std::string parts() const override;
  const FrameRing* frames() const override { return &ring_; }
  std::string status() const override;
  void command(const nlohmann::json& command) override;
  std::string review(const std::string& script) override;

 private:
  /// What belongs to one session.
  struct Session {
    InputGuide guide;
    RunEdits edits;
  };
  /// What belongs to a segment of it.
  struct Segment;
  /// How the newest pose of the pen and of where it wants the part belong together.
  struct PenSpace {
    std::array<double, 7> raw, Y;
    std::array<double, 3> center;  ///< of mass of the held part, file frame, m
    double scale;
    std::uint64_t generation;
  };
  /// What ends a session for what the page wants instead.
  enum class Request { none, restart, put_down };
  /// Of the session that the page asked for by holding a part.
  enum class Start { none, asked, begun, refused };
  // The segment that begins, the one that ends, and a spare.
  static constexpr std::size_t kSlots = 4;

  void show(PageParts parts);
  void show(PageParts parts, std::shared_ptr<Segment> segment);
  void note_suspended(const InitialContactReport& start) noexcept;
  void lead(const nlohmann::json& command);
  void edit(const nlohmann::json& command);
  void edit_at_rest(const nlohmann::json& command, std::unique_lock<std::mutex>& lock);
  void put_down();
  void restart();

  const SceneFile file_;
  const bool loose_;  // the scene holds no part
  const bool virtual_time_;
  const bool restartable_;
  const bool led_;
  std::atomic<bool>& stop_;
  const ScriptReview review_;
  FrameRing ring_;
  Frame frame_;  // of the thread that runs the sessions, as its contact loop
  Mailbox<PenSpace> pen_;

  std::atomic<bool> paused_;
  std::atomic<std::int64_t> steps_{0};  // to make while paused
  std::atomic<bool> changing_{false};   // a change waits for ticks
  std::atomic<double> speed_{1};        // virtual seconds in a second; infinite: as fast as it goes
  double paced_t_ = 0;                  // of the contact loop's thread: where pacing began
  std::int64_t paced_ns_ = 0;

  std::mutex editing_;               // one edit at a time; taken before mutex_
  std::mutex reviewing_;             // one report at a time
  mutable std::mutex mutex_;         // of the server's threads and of the one between its sessions; no loop takes it
  std::condition_variable changed_;  // what is held, or start_
  std::shared_ptr<Session> session_;
  std::shared_ptr<Segment> segment_;
  std::array<std::atomic<Segment*>, kSlots> by_number_{};
  Segment* looped_ = nullptr;  // of the contact loop's thread
  PageParts parts_;
  Bundle bundle_;
  Vec3 center_;                                       // of mass of the held part, file frame
  mutable std::shared_ptr<const std::string> bytes_;  // of the bundle; null: to be made
  std::uint64_t generation_ = 0;                      // of what the page shows: sessions and changes
  Request request_ = Request::none;
  Start start_ = Start::none;
  std::string refusal_;  // why start_ is refused
};

}  // namespace tegotae::view
