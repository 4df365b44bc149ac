#pragma once

#include <string>
#include <string_view>

namespace tegotae {

/// Throws Error with the number of an entity that has an empty list where ISO 10303 wants none, in kinds of which
/// OpenCASCADE then follows null pointers, or takes a point for the origin.
void require_lists(const std::string& path, std::string_view bytes);

}  // namespace tegotae
