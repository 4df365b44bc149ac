#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "tegotae/core/export.hpp"
#include "tegotae/device/shm.h"

namespace tegotae TEGOTAE_EXPORT {

class Segment;

/// Reads a shared-memory segment (shm.h) without taking part.
class ChannelReader {
 public:
  /// Opens an existing segment for reading, whether or not others use it. `name` is a POSIX shared-memory name such as
  /// "/tegotae-pen"; the slash is optional. Throws Error (kind device) unless the segment belongs to this user, no
  /// other user may open it, its size, magic and version are those of this library, and its device's process lives.
  static ChannelReader open(const std::string& name);

  ~ChannelReader();
  ChannelReader(ChannelReader&&) noexcept;  ///< afterwards the other one may only be destroyed or assigned to
  ChannelReader& operator=(ChannelReader&&) noexcept;  ///< as the constructor; releases its own segment

  const std::string& name() const noexcept;  ///< name with the slash
  std::uint64_t owner_pid() const noexcept;  ///< process id of the device
  /// Returns the time of creation, ns, monotonic clock. It distinguishes a segment from its successor.
  std::int64_t created_ns() const noexcept;

  /// Reads the newest complete write of the device. Returns false, and leaves `payload` unchanged, when the device has
  /// not written yet or is stuck in a write. Never waits, allocates or throws.
  bool read(tegotae_shm_device& payload) const noexcept;
  bool read(tegotae_shm_application& payload) const noexcept;  ///< the same for the application
  bool read(tegotae_shm_statistics& payload) const noexcept;   ///< the same for the statistics of the servo

 protected:
  explicit ChannelReader(std::unique_ptr<Segment> segment);  ///< takes a mapped segment
  std::unique_ptr<Segment> segment_;                         ///< the mapping; null after a move
};

/// One end of a segment. The device's side creates the segment, the application attaches to it.
class Channel : public ChannelReader {
 public:
  /// Creates a segment that only this user may open. With an empty name the library generates one that is unique to
  /// this process. The call replaces a segment that a dead process left, and refuses to replace that of a living one.
  /// It also removes segments that killed processes left under generated names. The destructor of Channel removes the
  /// segment. Throws Error (kind device) with the cause.
  static Channel create(const std::string& name = {});
  /// Attaches an application; a segment has at most one. Throws Error (kind device) as ChannelReader::open does, and
  /// when another application is attached.
  static Channel attach(const std::string& name);

  /// Writes the slot of the device. Its only writer is the device's servo. Never waits, allocates or throws.
  void write(const tegotae_shm_device& payload) noexcept;
  void write(const tegotae_shm_application& payload) noexcept;  ///< the same; the only writer is the application
  void write(const tegotae_shm_statistics& payload) noexcept;   ///< the same; the only writer is the servo

 private:
  using ChannelReader::ChannelReader;
};

}  // namespace tegotae
