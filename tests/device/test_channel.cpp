#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <thread>
#include <vector>

#include "catch.hpp"
#include "child_process.hpp"
#include "shm_reader.h"
#include "tegotae/core/error.hpp"
#include "tegotae/transport/channel.hpp"

using namespace tegotae;

namespace {

/// The raw segment of a name, past the library.
struct RawSegment {
  int fd;
  tegotae_shm_segment* memory;
  explicit RawSegment(const std::string& name) : fd(shm_open(name.c_str(), O_RDWR, 0)) {
    memory = static_cast<tegotae_shm_segment*>(
        mmap(nullptr, sizeof(tegotae_shm_segment), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0));
  }
  ~RawSegment() {
    munmap(memory, sizeof(tegotae_shm_segment));
    close(fd);
  }
};

/// A payload in which every word is `value`.
tegotae_shm_application filled(std::uint64_t value) {
  std::vector<std::uint64_t> words(sizeof(tegotae_shm_application) / 8, value);
  tegotae_shm_application payload;
  std::memcpy(&payload, words.data(), sizeof payload);
  return payload;
}

/// The value of all words, or -1 when they differ: a torn read.
std::int64_t value_of(const tegotae_shm_application& payload) {
  std::uint64_t words[sizeof(tegotae_shm_application) / 8];
  std::memcpy(words, &payload, sizeof payload);
  for (std::uint64_t word : words)
    if (word != words[0]) return -1;
  return static_cast<std::int64_t>(words[0]);
}

}  // namespace

TEST_CASE("two ends of a channel see each other's writes", "[device]") {
  Channel servo = Channel::create();
  Channel application = Channel::attach(servo.name());
  tegotae_shm_device pen{};
  CHECK_FALSE(application.read(pen));
  pen.tick = 5;
  pen.torque[2] = -0.25;
  servo.write(pen);
  tegotae_shm_device seen{};
  REQUIRE(application.read(seen));
  CHECK(std::memcmp(&pen, &seen, sizeof pen) == 0);

  tegotae_shm_device in_c{};
  REQUIRE(c_read_device(servo.name().c_str(), &in_c) == 1);
  CHECK(std::memcmp(&pen, &in_c, sizeof pen) == 0);
  const tegotae_shm_application proxy = filled(9);
  REQUIRE(c_write_application(servo.name().c_str(), &proxy) == 1);
  tegotae_shm_application received{};
  REQUIRE(servo.read(received));
  CHECK(value_of(received) == 9);
}

TEST_CASE("no read is ever torn", "[device]") {
  Channel writer = Channel::create();
  Channel reader = Channel::attach(writer.name());
  constexpr std::uint64_t kWrites = 2'000'000;
  std::atomic<bool> done{false};
  std::thread thread([&] {
    for (std::uint64_t i = 1; i <= kWrites; ++i) writer.write(filled(i));
    done = true;
  });
  std::int64_t last = 0;
  std::uint64_t reads = 0;
  std::uint64_t torn = 0;
  std::uint64_t backwards = 0;
  tegotae_shm_application payload;
  while (!done) {
    if (!reader.read(payload)) continue;
    const std::int64_t value = value_of(payload);
    ++reads;
    if (value < 0) ++torn;
    if (value < last) ++backwards;
    last = value;
  }
  thread.join();
  CHECK(reads > 1000);
  CHECK(torn == 0);
  CHECK(backwards == 0);
  REQUIRE(reader.read(payload));
  CHECK(value_of(payload) == kWrites);
}

TEST_CASE("a writer that died while writing is not waited for, and its successor is heard", "[device]") {
  Channel channel = Channel::create();
  channel.write(filled(1));
  {
    RawSegment raw(channel.name());
    raw.memory->application_counter |= 1;
  }
  tegotae_shm_application payload = filled(7);
  CHECK_FALSE(channel.read(payload));
  CHECK(value_of(payload) == 7);
  channel.write(filled(2));
  REQUIRE(channel.read(payload));
  CHECK(value_of(payload) == 2);
}

TEST_CASE("a segment is private, unique and gone afterwards", "[device]") {
  std::string name;
  {
    Channel channel = Channel::create();
    Channel other = Channel::create();
    name = channel.name();
    CHECK(other.name() != name);
    RawSegment raw(name);
    struct stat info;
    fstat(raw.fd, &info);
    CHECK((info.st_mode & 0777) == 0600);
    CHECK(info.st_uid == geteuid());
    CHECK_THROWS_WITH(Channel::create(name), Catch::Contains("in use"));
    Channel moved = std::move(channel);
    CHECK(moved.name() == name);
    CHECK_NOTHROW(Channel::attach(name));
  }
  CHECK_THROWS_WITH(Channel::attach(name), Catch::Contains(name) && Catch::Contains("there is none"));
}

TEST_CASE("a segment that is not of this user and protocol is refused", "[device]") {
  Channel channel = Channel::create();
  const std::string name = channel.name();
  RawSegment raw(name);
  SECTION("magic") {
    raw.memory->magic ^= 1;
    CHECK_THROWS_WITH(Channel::attach(name), Catch::Contains("not a segment of this protocol"));
  }
  SECTION("version") {
    raw.memory->version = 99;
    CHECK_THROWS_WITH(Channel::attach(name), Catch::Contains("version 99"));
  }
  SECTION("said size") {
    raw.memory->size = 10;
    CHECK_THROWS_WITH(Channel::attach(name), Catch::Contains("10 bytes"));
  }
  SECTION("real size") {
    REQUIRE(ftruncate(raw.fd, 64) == 0);
    CHECK_THROWS_WITH(Channel::attach(name), Catch::Contains("64 bytes"));
  }
  SECTION("permission") {
    REQUIRE(fchmod(raw.fd, 0644) == 0);
    CHECK_THROWS_WITH(Channel::attach(name), Catch::Contains("other users"));
  }
  SECTION("owner") {
    if (fchown(raw.fd, 65534, -1) != 0) {
      std::cout << "SKIPPED: only root can give a segment to another user\n";
      return;
    }
    CHECK_THROWS_WITH(Channel::attach(name), Catch::Contains("another user"));
  }
}

TEST_CASE("the memory of a segment is there before it is written", "[device]") {
  const Channel channel = Channel::create();
  struct stat info;
  REQUIRE(stat(("/dev/shm" + channel.name()).c_str(), &info) == 0);
  CHECK(info.st_size == static_cast<off_t>(sizeof(tegotae_shm_segment)));
  CHECK(info.st_blocks * 512 >= info.st_size);
}

TEST_CASE("the segment of a killed process is removed by the next one, that of a living one stays", "[device]") {
  const Channel living = Channel::create();
  const auto file_of = [](const std::string& name) { return "/dev/shm" + name; };
  std::string left;
  {
    test::ChildProcess child([](const auto& say) {
      const Channel channel = Channel::create();
      say(std::stol(channel.name().substr(channel.name().rfind('-') + 1)));
      pause();
    });
    left = "/tegotae-" + std::to_string(child.pid()) + "-" + std::to_string(child.hear());
    REQUIRE(std::filesystem::exists(file_of(left)));
    const Channel beside = Channel::create();
    CHECK(std::filesystem::exists(file_of(left)));  // it lives
  }
  REQUIRE(std::filesystem::exists(file_of(left)));
  const Channel next = Channel::create();
  CHECK_FALSE(std::filesystem::exists(file_of(left)));
  CHECK(std::filesystem::exists(file_of(living.name())));
  CHECK_NOTHROW(Channel::attach(living.name()));
}

TEST_CASE("a segment is none of the standard descriptors", "[device]") {
  test::ChildProcess child([](const auto& say) {
    for (int fd = 0; fd <= 2; ++fd) close(fd);
    const Channel channel = Channel::create(), application = Channel::attach(channel.name());
    std::int64_t used = 0;
    for (int fd = 0; fd <= 2; ++fd) used += fcntl(fd, F_GETFD) >= 0 ? 1 : 0;
    say(used);
  });
  CHECK(child.hear() == 0);
  CHECK(child.wait() == 0);
}
