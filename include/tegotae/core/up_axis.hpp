#pragma once

#include "tegotae/core/export.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Axis of the world that points up, for programs that display parts. No computation depends on it. Gravity has a
/// direction of its own (WeightSettings).
enum class UpAxis { x /**< x is up */, y /**< y is up */, z /**< z is up */ };

/// Returns "x", "y" or "z".
constexpr const char* to_string(UpAxis up) {
  return up == UpAxis::x ? "x" : up == UpAxis::y ? "y" : "z";
}

}  // namespace tegotae
