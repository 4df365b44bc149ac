// Names of segments whose processes died, with real processes.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <cstring>
#include <iostream>
#include <list>
#include <string>

#include "catch.hpp"
#include "child_process.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/transport/channel.hpp"

using namespace tegotae;
using test::ChildProcess;

namespace {

/// A name of this test process, removed when it goes.
struct Name {
  std::string text = "/tegotae-takeover-" + std::to_string(getpid());
  Name() { shm_unlink(text.c_str()); }
  ~Name() { shm_unlink(text.c_str()); }
};

const auto create_and_stay = [](const std::string& name) {
  return [name](auto say) {
    Channel channel = Channel::create(name);
    tegotae_shm_device pen{};
    pen.tick = 41;
    channel.write(pen);
    say(1);
    for (;;) pause();
  };
};

/// An object under the name, past the library, with `bytes` of `content` in front.
void put(const std::string& name, const void* content, std::size_t bytes, std::size_t size) {
  const int fd = shm_open(name.c_str(), O_RDWR | O_CREAT | O_EXCL, 0600);
  REQUIRE(fd >= 0);
  REQUIRE(ftruncate(fd, static_cast<off_t>(size)) == 0);
  REQUIRE(pwrite(fd, content, bytes, 0) == static_cast<ssize_t>(bytes));
  close(fd);
}

}  // namespace

TEST_CASE("a living device keeps its name, a killed one loses it", "[device]") {
  const Name name;
  ChildProcess device(create_and_stay(name.text));
  device.hear();
  CHECK_THROWS_WITH(Channel::create(name.text),
                    Catch::Contains("alive") && Catch::Contains("process " + std::to_string(device.pid())));
  tegotae_shm_device pen{};
  {
    const ChannelReader reader = ChannelReader::open(name.text);
    CHECK(reader.owner_pid() == static_cast<std::uint64_t>(device.pid()));
    REQUIRE(reader.read(pen));
    CHECK(pen.tick == 41);
  }
  const std::string dead = "process " + std::to_string(device.pid());
  device.kill(SIGKILL);
  CHECK_THROWS_WITH(Channel::attach(name.text), Catch::Contains("gone") && Catch::Contains(dead));
  CHECK_THROWS_WITH(ChannelReader::open(name.text), Catch::Contains("gone") && Catch::Contains(dead));
  const Channel successor = Channel::create(name.text);
  CHECK(successor.owner_pid() == static_cast<std::uint64_t>(getpid()));
  // Nothing of the predecessor is left.
  CHECK_FALSE(successor.read(pen));
  CHECK_NOTHROW(Channel::attach(name.text));
}

TEST_CASE("a process id that is in use again does not protect a dead segment", "[device]") {
  const Name name;
  tegotae_shm_segment left{};
  left.magic = TEGOTAE_SHM_MAGIC;
  left.version = TEGOTAE_SHM_VERSION;
  left.size = sizeof left;
  left.owner_pid = static_cast<std::uint64_t>(getpid());  // alive, but it holds no lock
  put(name.text, &left, sizeof left, sizeof left);
  CHECK_THROWS_WITH(Channel::attach(name.text), Catch::Contains("gone"));
  CHECK_NOTHROW(Channel::create(name.text));
}

TEST_CASE("segments of another version and unfinished ones are replaced, foreign objects are not", "[device]") {
  const Name name;
  SECTION("another version") {
    const std::uint64_t left[4] = {TEGOTAE_SHM_MAGIC, 1, 0, 0};
    put(name.text, left, sizeof left, 704);
    CHECK_NOTHROW(Channel::create(name.text));
  }
  SECTION("killed before the size was set") {
    put(name.text, "", 0, 0);
    CHECK_NOTHROW(Channel::create(name.text));
  }
  SECTION("killed before the magic was stored") {
    put(name.text, "", 0, sizeof(tegotae_shm_segment));
    CHECK_NOTHROW(Channel::create(name.text));
  }
  SECTION("foreign") {
    put(name.text, "somebody's data", 15, 4096);
    CHECK_THROWS_WITH(Channel::create(name.text), Catch::Contains("not a segment of this protocol"));
    const int fd = shm_open(name.text.c_str(), O_RDONLY, 0);
    CHECK(fd >= 0);  // still there
    close(fd);
  }
  SECTION("another user's") {
    put(name.text, "", 0, 0);
    const int fd = shm_open(name.text.c_str(), O_RDWR, 0);
    const bool given = fchown(fd, 65534, -1) == 0;
    close(fd);
    if (!given) {
      std::cout << "SKIPPED: only root can give a segment to another user\n";
      return;
    }
    CHECK_THROWS_WITH(Channel::create(name.text), Catch::Contains("another user"));
  }
}

TEST_CASE("of many processes that want a dead device's name at once, one gets it", "[device]") {
  const Name name;
  for (int round = 0; round < 20; ++round) {
    {
      ChildProcess device(create_and_stay(name.text));
      device.hear();
    }
    std::list<ChildProcess> baselines;
    for (int i = 0; i < 6; ++i)
      baselines.emplace_back([&](auto say) {
        try {
          const Channel channel = Channel::create(name.text);
          say(1);
          for (;;) pause();
        } catch (const Error&) {
          say(0);
        }
      });
    std::int64_t winners = 0;
    for (ChildProcess& baseline : baselines) winners += baseline.hear();
    REQUIRE(winners == 1);
    REQUIRE_NOTHROW(ChannelReader::open(name.text));
  }
}

TEST_CASE("a device that ends leaves its successor's segment alone", "[device]") {
  const Name name;
  {
    const Channel first = Channel::create(name.text);
    shm_unlink(name.text.c_str());  // somebody tidies up
    static const Channel second = Channel::create(name.text);
  }
  CHECK_NOTHROW(ChannelReader::open(name.text));
}

TEST_CASE("a device has one application at a time; a killed one makes room", "[device]") {
  const Channel device = Channel::create();
  {
    const Channel application = Channel::attach(device.name());
    CHECK_THROWS_WITH(Channel::attach(device.name()), Catch::Contains("another application is attached"));
    CHECK_NOTHROW(ChannelReader::open(device.name()));
  }
  ChildProcess application([&](auto say) {
    const Channel channel = Channel::attach(device.name());
    say(1);
    for (;;) pause();
  });
  application.hear();
  CHECK_THROWS_WITH(Channel::attach(device.name()), Catch::Contains("another application is attached"));
  application.kill(SIGKILL);
  CHECK_NOTHROW(Channel::attach(device.name()));
}

TEST_CASE("the slash of a name may be left out", "[device]") {
  const Name name;
  const Channel device = Channel::create(name.text.substr(1));
  CHECK(device.name() == name.text);
  CHECK(Channel::attach(name.text.substr(1)).name() == name.text);
  CHECK_THROWS_WITH(Channel::create("a/b"), Catch::Contains("/a/b"));
}
