// One writer, several readers: every value that is read is one that was written, and the newest never goes back.
#include <atomic>
#include <thread>
#include <vector>

#include "catch.hpp"
#include "core/latest_value.hpp"

using namespace tegotae;

TEST_CASE("values are read whole and in order", "[latest_value]") {
  LatestValue<7> latest;
  CHECK(latest.read() == LatestValue<7>::Values{});
  std::atomic<bool> end{false};
  std::atomic<int> torn{0}, back{0};
  std::atomic<long> changes{0};
  std::vector<std::thread> readers;
  for (int i = 0; i < 3; ++i)
    readers.emplace_back([&] {
      double last = 0;
      while (!end) {
        const LatestValue<7>::Values v = latest.read();
        for (std::size_t k = 1; k < v.size(); ++k) torn += v[k] != v[0] + static_cast<double>(k) && v[0] != 0;
        back += v[0] < last;
        changes += v[0] != last;
        last = v[0];
      }
    });
  LatestValue<7>::Values v{};
  for (int n = 1; n <= 200'000; ++n) {
    for (std::size_t k = 0; k < v.size(); ++k) v[k] = n + static_cast<double>(k);
    latest.write(v);
    if (n % 64 == 0) std::this_thread::yield();
  }
  while (changes == 0) std::this_thread::yield();
  end = true;
  for (std::thread& t : readers) t.join();
  CHECK(torn == 0);
  CHECK(back == 0);
  CHECK(latest.read()[0] == 200'000);
}
