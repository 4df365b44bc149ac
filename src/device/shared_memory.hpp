#pragma once

#include <string>

#include "tegotae/device/shm.h"

namespace tegotae {

/// A name that no other segment of this process has had.
std::string unique_segment_name();
/// Creates and maps the segment `name` (0600, header filled in). False when the name is taken. Throws Error otherwise.
bool create_segment(const std::string& name, tegotae_shm_segment*& segment);
/// Maps an existing segment after checking owner, permission, size, magic and version. Throws Error.
tegotae_shm_segment* attach_segment(const std::string& name);
void unmap_segment(tegotae_shm_segment* segment) noexcept;
void unlink_segment(const std::string& name) noexcept;

}  // namespace tegotae
