#pragma once

#include <memory>
#include <string>

#include "tegotae/device/shm.h"

namespace tegotae {

/// What a process is to a segment. Device and application hold a lock on a byte of it while they live (shm.h).
enum class SegmentRole { device, application, observer };

/// A mapped segment, and this process's hold on it.
class Segment {
 public:
  /// Creates the segment `name` (0600, header filled in) as its device. What a dead process left under that name is
  /// replaced. Throws Error when a living process has the name, or something that is not a segment of this protocol.
  static std::unique_ptr<Segment> create(const std::string& name);
  /// Maps an existing segment after checking owner, permission, size, magic and version, and that its device lives.
  /// Throws Error, as an application also when another one is attached.
  static std::unique_ptr<Segment> open(const std::string& name, SegmentRole role);
  /// The device unlinks its segment.
  ~Segment();
  Segment(const Segment&) = delete;
  Segment& operator=(const Segment&) = delete;

  const std::string& name() const noexcept { return name_; }
  /// An observer's mapping is read-only.
  tegotae_shm_segment* memory() const noexcept { return memory_; }

 private:
  Segment(std::string name, int fd, SegmentRole role);
  std::string name_;
  int fd_;  // holds the lock
  SegmentRole role_;
  tegotae_shm_segment* memory_;
};

/// Removes the segments with names of their own (unique_segment_name) that killed processes of this user left.
void remove_left_segments();

/// A name that no other segment of this process has had.
std::string unique_segment_name();

}  // namespace tegotae
