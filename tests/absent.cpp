// The listener's interface of Catch2 v2.
#define CATCH_CONFIG_EXTERNAL_INTERFACES
#include "absent.hpp"

#include <cstdio>
#include <cstdlib>
#include <iostream>

#include "catch.hpp"

namespace {

constexpr int kSkipped = 77;  // SKIP_RETURN_CODE of tegotae_add_test

bool absent = false, passed = false;

void end() {
  if (!absent || !passed) return;
  std::cout.flush();
  std::fflush(nullptr);
  std::_Exit(kSkipped);
}

#if __has_include(<catch2/catch_all.hpp>)
using Base = Catch::EventListenerBase;
#else
using Base = Catch::TestEventListenerBase;
#endif

class Watcher : public Base {
 public:
  using Base::Base;
  void testRunEnded(const Catch::TestRunStats& stats) override {
    passed = stats.totals.assertions.failed == 0 && !stats.aborting;
    std::atexit(end);
    Base::testRunEnded(stats);
  }
};
CATCH_REGISTER_LISTENER(Watcher)

}  // namespace

namespace tegotae::test {

void note_absent(const std::string& what) {
  absent = true;
  std::cout << "SKIPPED: " << what << std::endl;
}

}  // namespace tegotae::test
