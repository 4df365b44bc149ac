#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

#include "tegotae/core/latency_histogram.hpp"

namespace tegotae::apps {

/// A number, or null where there is none (JSON has no NaN).
inline nlohmann::ordered_json json_number(double x) {
  return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json(nullptr);
}

inline nlohmann::ordered_json to_json(const LatencySummary& p) {
  return {{"p50", json_number(p.p50)},
          {"p99", json_number(p.p99)},
          {"p999", json_number(p.p999)},
          {"max", json_number(p.max)}};
}

}  // namespace tegotae::apps
