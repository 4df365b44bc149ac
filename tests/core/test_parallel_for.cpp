#include <atomic>
#include <stdexcept>

#include "catch.hpp"
#include "core/parallel_for.hpp"

using namespace tegotae;

TEST_CASE("every job is done once, and each is told") {
  for (const int threads : {1, 2, 5}) {
    std::atomic<int> sum{0};
    int last = 0;
    parallel_for(
        100, threads, [&](int i) { sum += i; }, [&](int count) { last = count; });
    CHECK(sum == 99 * 100 / 2);
    CHECK(last == 100);
  }
}

TEST_CASE("what a job or who is told throws ends the others") {
  for (const int threads : {1, 2, 5})
    for (const bool told : {false, true}) {
      CAPTURE(threads, told);
      std::atomic<int> done{0};
      const auto fail = [] { throw std::runtime_error("enough"); };
      const auto job = [&](int i) {
        ++done;
        if (!told && i == 10) fail();
      };
      const auto tell = [&](int count) {
        if (told && count == 10) fail();
      };
      CHECK_THROWS_WITH(parallel_for(1000000, threads, job, tell), "enough");
      CHECK(done >= 10);
      CHECK(done < 1000000);
    }
}
