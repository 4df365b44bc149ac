#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace tegotae {

/// `x` with `places` digits after the point; what rounds to 0 has no sign.
inline std::string fixed_text(double x, int places) {
  char text[352];  // the largest number has 309 digits before the point
  std::snprintf(text, sizeof text, "%.*f", places, x);
  const std::string out = text;
  return out[0] == '-' && out.find_first_not_of("-0.") == std::string::npos ? out.substr(1) : out;
}

/// `x` as people write it: `digits` significant digits, but all of those before the point, and at most six places after
/// it. No exponent, no -0; from 1e15 on a power of ten.
inline std::string number_text(double x, int digits) {
  constexpr double kLongest = 1e15;
  constexpr int kMostPlaces = 6;
  char text[64];
  std::snprintf(text, sizeof text, "%.*g", digits, x + 0.0);  // -0 + 0 is 0
  std::string out = text;
  if (out.find('e') == std::string::npos || !std::isfinite(x)) return out;
  const auto without_zeros = [](std::string number) {
    if (number.find('.') == std::string::npos) return number;
    number.erase(number.find_last_not_of('0') + 1);
    if (number.back() == '.') number.pop_back();
    return number;
  };
  if (std::abs(x) < kLongest) return without_zeros(fixed_text(x, std::abs(x) < 1 ? kMostPlaces : 0));
  const std::size_t e = out.find('e');
  const std::string factor = out.substr(0, e), power = "10^" + std::to_string(std::atoi(out.c_str() + e + 1));
  return factor == "1" ? power : factor + " x " + power;
}

}  // namespace tegotae
