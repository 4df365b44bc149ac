// The summary that a program prints with --json.
#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/run_program.hpp"
#include "catch.hpp"

namespace tegotae::test {

inline void check_percentiles(const nlohmann::json& p) {
  REQUIRE(p.size() == 4);
  CHECK(p.at("p50").get<double>() <= p.at("p99").get<double>());
  CHECK(p.at("p99").get<double>() <= p.at("p999").get<double>());
  CHECK(p.at("p999").get<double>() <= p.at("max").get<double>());
}

/// The one line of JSON on stdout, all fields there.
inline nlohmann::json summary_of(const Output& o) {
  INFO("stdout: " << o.out);
  INFO("stderr: " << o.err);
  REQUIRE(std::count(o.out.begin(), o.out.end(), '\n') == 1);
  const nlohmann::json j = nlohmann::json::parse(o.out);
  for (const char* key :
       {"ticks", "seconds", "depth_m", "contacts_max", "penetrating", "force_max_n", "torque_max_nm"}) {
    INFO(key);
    CHECK(j.at(key).is_number());
  }
  CHECK(j.at("completed").is_boolean());
  check_percentiles(j.at("tick_us"));
  check_percentiles(j.at("servo").at("late_us"));
  CHECK(j.at("servo").at("rate_hz").is_number());
  CHECK(j.at("servo").at("missed").is_number_integer());
  return j;
}

}  // namespace tegotae::test
