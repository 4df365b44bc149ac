#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <string>

namespace tegotae {

/// The whole number `value`. Throws json::type_error when it is none or T cannot hold it: json's own get<T>() casts
/// 1e300 and -1 too.
template <typename T>
T whole_number(const nlohmann::json& value) {
  constexpr T kMin = std::numeric_limits<T>::lowest(), kMax = std::numeric_limits<T>::max();
  if (value.is_number_unsigned()) {
    const auto number = value.get<std::uint64_t>();
    if (number <= static_cast<std::uint64_t>(kMax)) return static_cast<T>(number);
  } else if (value.is_number_integer() && std::numeric_limits<T>::is_signed) {
    const auto number = value.get<std::int64_t>();
    if (number >= static_cast<std::int64_t>(kMin) && number <= static_cast<std::int64_t>(kMax))
      return static_cast<T>(number);
  }
  throw nlohmann::json::type_error::create(
      302, "a whole number from " + std::to_string(kMin) + " to " + std::to_string(kMax) + " is expected", &value);
}

}  // namespace tegotae
