#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "loop/double_buffer.hpp"
#include "loop/running_scene.hpp"
#include "tegotae/loop/scene_change.hpp"

namespace tegotae {

/// The changes of a loop's scene: made in any thread, taken by the loop's, which never waits, allocates or frees.
class SceneChanges : public std::enable_shared_from_this<SceneChanges> {
 public:
  explicit SceneChanges(const RunningScene& first);

  /// See HapticLoop::change.
  SceneChange offer(const Scene& next, const std::function<void(std::uint64_t, const InitialContactReport&)>& ready);
  /// See SceneChange::cancel.
  bool cancel(SceneChange::Record& change);
  /// Name of the part that is held in the scene in force.
  std::string held() const;
  std::uint64_t in_force() const noexcept { return in_force_.load(std::memory_order_acquire); }

  // The loop's thread.
  /// The newest pending change, null when there is none. Pass it to come_into_force() or put_back().
  RunningScene* take() noexcept { return next_.take(); }
  void put_back(RunningScene* changed) noexcept;
  /// The loop now runs in `changed`, and no longer uses `before`.
  void come_into_force(RunningScene& changed, RunningScene* before) noexcept;

 private:
  DoubleBuffer<RunningScene> next_;
  std::atomic<std::uint64_t> in_force_{0};
  struct Known {
    std::shared_ptr<const std::vector<RunningScene::Obstacle>> obstacles;
    std::string held;
  };
  /// Obstacles of change `number`, which is in force; forgets those before it.
  std::shared_ptr<const std::vector<RunningScene::Obstacle>> obstacles_of(std::uint64_t number);

  // The loop's thread locks neither. Who changes holds `changing_` while a scene is built, which takes seconds;
  // `reading_` is held for `known_` alone, and after `changing_` where both are.
  std::mutex changing_;
  mutable std::mutex reading_;
  std::uint64_t last_ = 0;
  std::map<std::uint64_t, Known> known_;  // by change
};

}  // namespace tegotae
