#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "loop/proxy_loop.hpp"
#include "tegotae/loop/scene.hpp"
#include "tegotae/loop/scene_change.hpp"
#include "tegotae/mesh/mass.hpp"

namespace tegotae {

/// The scene, whose parts all have triangles and poses that can be. Throws Error for one that does not.
const Scene& checked(const Scene& scene);
/// Settings with nothing left open, for a held part whose bounding sphere has that radius (m). Throws Error.
ContactSettings completed(ContactSettings settings, double radius);
/// Of the held part, of a uniform density (kg/m³).
MassProperties mass_of_held(const Scene& scene, double density);

/// A scene with everything that a tick in it needs.
struct RunningScene {
  /// What the held part must keep out of.
  struct Obstacle {
    std::shared_ptr<const TriangleMesh> mesh;
    Pose pose;
  };

  std::uint64_t number = 0;                                ///< of the change that it came with
  std::shared_ptr<const std::vector<Obstacle>> obstacles;  ///< the fixed parts, by number
  std::vector<bool> fresh;  ///< of them: whether the scene of change `fresh_since` does not have it there
  std::uint64_t fresh_since = 0;
  std::string held;  ///< name of the held part
  std::shared_ptr<const TriangleMesh> held_mesh;
  bool keeps_out;  ///< no tick leaves the held part nearer to an obstacle than kGapFloor, pairs of start() aside
  ContactSettings settings;   ///< nothing left open
  MassProperties mass;        ///< of the held part
  double radius;              ///< of the held part about its center of mass, m
  CouplingSettings coupling;  ///< nothing left open
  HeldWeight weight;          ///< of the held part
  double scale;               ///< Scene::scale
  std::unique_ptr<ProxyLoop> loop;
  RunningScene* retired_before = nullptr;       ///< see DoubleBuffer
  std::shared_ptr<SceneChange::Record> change;  ///< that it came with; null: none

  /// Throws Error as HapticLoop's constructor.
  explicit RunningScene(const Scene& scene);
  /// Sets `fresh` and `fresh_since`.
  void compare(const std::vector<Obstacle>& old, std::uint64_t old_number);
  /// Does once what is slow or allocates the first time, where the held part is.
  void warm_up();
  ~RunningScene();
  RunningScene(const RunningScene&) = delete;
  RunningScene& operator=(const RunningScene&) = delete;
};

class SceneChanges;

/// What a change's handles share.
struct SceneChange::Record {
  Record(std::uint64_t number_in, const InitialContactReport& start_in, std::weak_ptr<SceneChanges> changes_in)
      : number(number_in), start(start_in), changes(std::move(changes_in)) {}

  const std::uint64_t number;
  const InitialContactReport start;
  const std::weak_ptr<SceneChanges> changes;
  std::atomic<ChangeState> state{ChangeState::pending};
};

}  // namespace tegotae
