// How programs refuse.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "apps/run_program.hpp"
#include "catch.hpp"

namespace tegotae::test {

/// Checks that a program ended with exit code 2 and one line on stderr that has each of `named` in it.
inline void check_refused(const Output& o, const std::vector<std::string>& named) {
  INFO("stdout: " << o.out);
  INFO("stderr: " << o.err);
  CHECK(o.code == 2);
  CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
  for (const std::string& text : named) {
    INFO("named: " << text);
    CHECK(o.err.find(text) != std::string::npos);
  }
}

}  // namespace tegotae::test
