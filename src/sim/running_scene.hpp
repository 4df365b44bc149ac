#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "sim/proxy_loop.hpp"
#include "tegotae/mesh/mass.hpp"
#include "tegotae/sim/scene.hpp"

namespace tegotae {

/// A scene with everything that a tick in it needs.
struct RunningScene {
  std::uint64_t number = 0;  ///< of the change that it came with
  std::string held;          ///< name of the held part
  ContactSettings settings;  ///< nothing left open
  MassProperties mass;       ///< of the held part
  std::unique_ptr<ProxyLoop> loop;
  RunningScene* done_before = nullptr;  ///< see Handover

  /// Throws Error as HapticLoop's constructor.
  explicit RunningScene(const Scene& scene);
  /// Does once what is slow or allocates the first time, where the held part is.
  void warm_up();
};

}  // namespace tegotae
