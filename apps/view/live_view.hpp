#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>

#include "tegotae/sim/session.hpp"
#include "view/frame_maker.hpp"
#include "view/frame_ring.hpp"
#include "view/source.hpp"

namespace tegotae::view {

/// A running session for the page: shows its ticks, and takes the page's commands. The loops meet the server's threads
/// in a ring of frames, a hand guide and atomics only.
class LiveView final : public RunObserver, public ViewSource {
 public:
  /// `stop` ends the session (RunSettings::stop); commands that need another session set it. Keeps references.
  /// `restartable`: whether the page may ask for that; `led`: whether the session's hand follows guide().
  LiveView(const SceneFile& file, bool virtual_time, bool restartable, bool led, std::atomic<bool>& stop);
  ~LiveView() override;

  /// Another session begins, of `file`.
  void show(const SceneFile& file);
  /// What leads the hand in the session now.
  const HandGuide& guide() const;
  /// How the held part starts in it; which pairs are suspended goes to the page.
  void started(const StartReport& start) noexcept;
  /// Whether the page asked for another session; then `held` is the part to hold (its number in the scene) and `keep`
  /// whether the parts shall stay where they are. Asking takes the request away.
  bool take_request(std::size_t& held, bool& keep);
  /// X of the newest frame; false before the first.
  bool pose(Pose& X) const;

  void before_tick(double t) override;
  void after_tick(const TickView& tick) noexcept override;

  std::shared_ptr<const std::string> scene() const override;
  const FrameRing* frames() const override { return &ring_; }
  std::string status() const override;
  void command(const nlohmann::json& command) override;

 private:
  struct Run;  // what belongs to one session

  void lead(const nlohmann::json& command);
  void hold(const nlohmann::json& command);
  void request(std::size_t held, bool keep);

  const bool virtual_time_;
  const bool restartable_;
  const bool led_;
  std::atomic<bool>& stop_;
  FrameRing ring_;
  Frame frame_;  // of the contact loop's thread

  std::atomic<bool> paused_;
  std::atomic<std::int64_t> steps_{0};  // to make while paused
  std::atomic<double> speed_{1};        // virtual seconds in a second; infinite: as fast as it goes
  double paced_t_ = 0;                  // of the contact loop's thread: where pacing began
  std::int64_t paced_ns_ = 0;

  mutable std::mutex mutex_;  // of the server's threads and of show(); no loop takes it
  std::shared_ptr<Run> run_;
  Run* looped_ = nullptr;  // the same, for the contact loop
  std::uint64_t generation_ = 0;
  bool requested_ = false, keep_ = false;
  std::size_t held_ = 0;
};

}  // namespace tegotae::view
