#pragma once

#include <string>

#include "tegotae/core/export.hpp"
#include "tegotae/device/shm.h"

namespace tegotae TEGOTAE_EXPORT {

/// One end of a shared-memory segment (shm.h). The servo creates it or attaches to it, and so does the application.
class Channel {
 public:
  /// Creates a segment that only this user may open. `name` is a POSIX shared-memory name such as "/tegotae-pen"; empty
  /// chooses one that is unique to this process. It is unlinked when the Channel goes. Throws Error with the cause.
  static Channel create(const std::string& name = {});
  /// Opens an existing segment. Throws Error unless it belongs to this user, nobody else may open it, and size, magic
  /// and version are those of this library.
  static Channel attach(const std::string& name);

  ~Channel();
  Channel(Channel&& other) noexcept;
  Channel& operator=(Channel&& other) noexcept;

  const std::string& name() const noexcept { return name_; }

  // Each slot has one writer. A read gives one whole write, or false (and an untouched argument) when nothing was
  // written yet or the writer is stuck in a write. None of them waits, allocates or throws.
  void write(const tegotae_shm_device& payload) noexcept;
  void write(const tegotae_shm_application& payload) noexcept;
  void write(const tegotae_shm_statistics& payload) noexcept;
  bool read(tegotae_shm_device& payload) const noexcept;
  bool read(tegotae_shm_application& payload) const noexcept;
  bool read(tegotae_shm_statistics& payload) const noexcept;

 private:
  Channel(std::string name, tegotae_shm_segment* segment, bool owner);
  std::string name_;
  tegotae_shm_segment* segment_ = nullptr;
  bool owner_ = false;
};

}  // namespace tegotae
