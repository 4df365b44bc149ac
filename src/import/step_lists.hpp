#pragma once

#include <string>
#include <string_view>

namespace tegotae {

/// What `rename_unfilled` puts before a kind.
constexpr std::string_view kUnfilled = "UNFILLED_";

/// The text of a STEP file in which entities that have an empty list where ISO 10303 wants none are of kinds that
/// OpenCASCADE does not know, where it would follow null pointers or take a point for the origin. So what no shape is
/// made of does no harm, and what one is made of is refused as all unknown kinds are. Throws Error on a damaged entity.
std::string rename_unfilled(const std::string& path, std::string bytes);

}  // namespace tegotae
