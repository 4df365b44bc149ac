// The document's driver in C and reader in Python, run against the library.
#include <time.h>

#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "spawn.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/transport/attachment.hpp"

using namespace tegotae;
using test::Program;

namespace {

const std::string kName = "/tegotae-example-" + std::to_string(getpid());

void sleep_ms(long ms) {
  const timespec t = {0, ms * 1'000'000};
  nanosleep(&t, nullptr);
}

std::unique_ptr<Program> start_driver() {
  auto driver = std::make_unique<Program>(std::vector<std::string>{TEGOTAE_BIN_DIR "/example_driver", kName, "60"});
  for (int i = 0; i < 5000; ++i) {
    try {
      tegotae_shm_device pen;
      if (ChannelReader::open(kName).read(pen)) return driver;
    } catch (const Error&) {  // not yet
    }
    sleep_ms(1);
  }
  FAIL("the driver does not start");
  return driver;
}

}  // namespace

TEST_CASE("a driver in C serves an application of the library", "[examples]") {
  const std::unique_ptr<Program> driver = start_driver();
  {
    Attachment pen("shm:" + kName, {}, Vec3::Zero());
    const Vec3 place(0.1, 0.2, 0.3);  // of the part, which stays there, touching
    ProxyState part;
    part.X.p = place;
    part.touching = true;
    PenSample sample;
    double lowest = 1, highest = -1, most = 0, error = 0;
    int followed = 0;
    for (std::uint64_t tick = 0; followed < 1500 && tick < 20'000; ++tick) {
      if (pen.read(sample, monotonic_ns())) {
        ++followed;
        lowest = std::min(lowest, sample.state.pose.p.z());
        highest = std::max(highest, sample.state.pose.p.z());
        most = std::max(most, sample.wrench.force.norm());
        // What the coupling says of the very sample, where the limit of 3 N does not cut.
        const Vec3 wanted = CouplingSettings{}.stiffness * (place - sample.state.pose.p) -
                            CouplingSettings{}.damping * sample.state.velocity.v;
        if (sample.reason == ForceOff::none && wanted.norm() < 3)
          error = std::max(error, (sample.wrench.force - wanted).norm());
        CHECK(sample.wrench.force.norm() <= 3 * (1 + 1e-12));
      }
      pen.publish(part, tick, sample.state.sequence, monotonic_ns());
      sleep_ms(1);
    }
    CHECK(followed == 1500);
    CHECK(highest - lowest == Approx(0.01).epsilon(0.05));  // a stroke of 10 mm, about where the part was
    CHECK(lowest <= place.z() + 1e-4);
    CHECK(highest >= place.z() - 1e-4);
    CHECK(most > 1);
    CHECK(error < 1e-9);
    // A reader in Python sees what the library sees.
    Program reader({"/usr/bin/env", "python3", TEGOTAE_EXAMPLES_DIR "/reader.py", kName});
    const nlohmann::json seen = nlohmann::json::parse(reader.rest());
    CHECK(reader.wait() == 0);
    CHECK(seen.at("name") == "example in C");
    CHECK(seen.at("tick").get<std::uint64_t>() >= sample.tick);
    CHECK(seen.at("orientation") == nlohmann::json({1.0, 0.0, 0.0, 0.0}));
    CHECK(std::abs(seen.at("position")[2].get<double>() - place.z()) <= 0.0101);
    CHECK(seen.at("position")[0].get<double>() == Approx(place.x()));
  }
  // No application: no force, with the reason.
  sleep_ms(60);
  tegotae_shm_device pen;
  REQUIRE(ChannelReader::open(kName).read(pen));
  CHECK(pen.reason == TEGOTAE_SHM_REASON_WATCHDOG);
  CHECK(Vec3(pen.force).norm() == 0);
}

TEST_CASE("a second driver leaves a living one alone and takes over from a dead one", "[examples]") {
  const std::unique_ptr<Program> first = start_driver();
  CHECK(Program({TEGOTAE_BIN_DIR "/example_driver", kName, "1"}).wait() == 2);
  first->end(SIGKILL);
  const std::unique_ptr<Program> second = start_driver();
  CHECK(ChannelReader::open(kName).owner_pid() == static_cast<std::uint64_t>(second->pid()));
  second->end(SIGKILL);
  CHECK_NOTHROW(Channel::create(kName));  // the library takes over from it, too
}

TEST_CASE("a reader in Python refuses what is not a segment", "[examples]") {
  Program absent({"/usr/bin/env", "python3", TEGOTAE_EXAMPLES_DIR "/reader.py", kName + "-absent"});
  CHECK(absent.wait() != 0);
}
