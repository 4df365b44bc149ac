// Frames go through the ring whole or not at all, whoever is faster.
#include <atomic>
#include <thread>

#include "catch.hpp"
#include "view/frame_ring.hpp"

using namespace tegotae::view;

namespace {

// Every word of the frame tells its number.
void mark(Frame& f, std::uint64_t number) {
  f.tick = number;
  f.t = static_cast<double>(number);
  for (double& v : f.x) v = f.t;
  for (double& v : f.wrench) v = f.t;
  f.contacts = static_cast<std::uint32_t>(number);
  f.force_count = number % (f.forces.size() + 1);
  for (FrameForce& c : f.forces) c.normal[2] = f.t;
  f.pair_count = number % (kMaxPairs + 1);
  for (std::size_t i = 0; i < f.pair_count; ++i) {
    for (double& v : f.pairs[i].point) v = f.t;
    f.pairs[i].gap = f.t;
    f.pairs[i].part = static_cast<std::uint32_t>(number);
  }
}

bool whole(const Frame& f) {
  const double n = static_cast<double>(f.tick);
  bool good = f.t == n && f.contacts == static_cast<std::uint32_t>(f.tick) && f.pair_count == f.tick % (kMaxPairs + 1);
  good = good && f.force_count == f.tick % (f.forces.size() + 1) && f.forces.back().normal[2] == n;
  for (const double v : f.x) good = good && v == n;
  for (const double v : f.wrench) good = good && v == n;
  for (std::size_t i = 0; good && i < f.pair_count; ++i) {
    for (const double v : f.pairs[i].point) good = good && v == n;
    good = good && f.pairs[i].gap == n && f.pairs[i].part == static_cast<std::uint32_t>(f.tick);
  }
  return good;
}

}  // namespace

TEST_CASE("frames come in order, each once") {
  FrameRing ring;
  Frame frame, got;
  std::uint64_t missed = 0;
  FrameRing::Cursor cursor = ring.newest();
  CHECK_FALSE(ring.read(cursor, got, missed));
  for (std::uint64_t n = 0; n < 300; ++n) {
    mark(frame, n);
    ring.push(frame);
    REQUIRE(ring.read(cursor, got, missed));
    CHECK(got.tick == n);
    CHECK(whole(got));
    CHECK_FALSE(ring.read(cursor, got, missed));
  }
  CHECK(missed == 0);
}

TEST_CASE("a reader that was away misses the oldest and counts them") {
  FrameRing ring;
  Frame frame, got;
  FrameRing::Cursor cursor = 0;
  std::uint64_t missed = 0, read = 0, last = 0;
  for (std::uint64_t n = 0; n < 1000; ++n) {
    mark(frame, n);
    ring.push(frame);
  }
  while (ring.read(cursor, got, missed)) {
    CHECK((read == 0 || got.tick == last + 1));
    last = got.tick;
    ++read;
  }
  CHECK(last == 999);
  CHECK(read > 0);
  CHECK(read + missed == 1000);
  FrameRing::Cursor fresh = ring.newest();
  REQUIRE(ring.read(fresh, got, missed));
  CHECK(got.tick == 999);
}

TEST_CASE("readers at full speed never see half a frame") {
  FrameRing ring;
  constexpr std::uint64_t kFrames = 200'000;
  std::atomic<bool> done{false};
  std::atomic<std::uint64_t> torn{0}, lost{0};
  const auto reader = [&] {
    Frame got;
    FrameRing::Cursor cursor = 0;
    std::uint64_t missed = 0, read = 0, before = 0;
    for (bool last = false; !last;) {
      last = done;
      while (ring.read(cursor, got, missed)) {
        if (!whole(got) || (read > 0 && got.tick <= before)) ++torn;
        before = got.tick;
        ++read;
      }
    }
    if (read + missed != kFrames) ++lost;
  };
  std::thread a(reader), b(reader);
  Frame frame;
  for (std::uint64_t n = 0; n < kFrames; ++n) {
    mark(frame, n);
    ring.push(frame);
  }
  done = true;
  a.join();
  b.join();
  CHECK(torn == 0);
  CHECK(lost == 0);
}
