// What another process may write into a segment: the input is a list of (offset, bytes) that overwrite any part of it,
// header and counters too, with servo ticks and the application's reads in between.
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "fuzz/fuzz.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/servo/servo.hpp"
#include "tegotae/transport/contact_link.hpp"

namespace tegotae {

namespace {

/// A pen that is always enabled, so that only the safety chain stands between the segment and the hand.
class OpenPen final : public Device {
 public:
  DeviceInfo info() const override { return {}; }
  void start() override {}
  void stop() override {}
  DeviceState read() noexcept override { return {}; }
  void write(const Wrench& wrench) noexcept override { last = wrench; }
  DeviceStatus status() const noexcept override { return DeviceStatus::enabled; }
  ForceOff reason() const noexcept override { return ForceOff::none; }
  Wrench last;
};

/// A channel and the other process's view of its memory.
struct Shared {
  Channel channel = Channel::create();
  unsigned char* bytes = nullptr;
  Shared() {
    const int fd = shm_open(channel.name().c_str(), O_RDWR, 0);
    require(fd >= 0, "the segment opens");
    void* memory = mmap(nullptr, sizeof(tegotae_shm_segment), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    require(memory != MAP_FAILED, "the segment maps");
    close(fd);
    bytes = static_cast<unsigned char*>(memory);
  }
  ~Shared() { munmap(bytes, sizeof(tegotae_shm_segment)); }
};

constexpr std::int64_t kNow = 1'000'000'000'000;

/// One record of the input: two bytes of offset, one of length, the bytes.
std::string record(std::size_t offset, const std::string& bytes) {
  std::string s{static_cast<char>(offset & 0xff), static_cast<char>(offset >> 8), static_cast<char>(bytes.size())};
  return s + bytes;
}

std::string slot_seed(const tegotae_shm_application& payload) {
  std::string all;
  tegotae_shm_segment segment{};
  tegotae_shm_write(&segment.application_counter, segment.application, &payload, sizeof payload);
  const std::size_t begin = offsetof(tegotae_shm_segment, application_counter);
  const std::string bytes(reinterpret_cast<const char*>(&segment) + begin, sizeof payload + sizeof(std::uint64_t));
  for (std::size_t at = 0; at < bytes.size(); at += 100) all += record(begin + at, bytes.substr(at, 100));
  return all;
}

void look(const Shared& shared, OpenPen& pen, Servo& servo, const ContactLink& link, const WrenchLimits& limits) {
  servo.tick(kNow);
  constexpr double kRounding = 1 + 1e-9;
  require(pen.last.force.norm() <= kRounding * limits.force, "the force is finite and within its limit");
  require(pen.last.torque.norm() <= kRounding * limits.torque, "the torque is finite and within its limit");
  PenSample sample;
  if (link.read(sample)) {
    require(to_string(sample.status) != nullptr && to_string(sample.reason) != nullptr, "every value has a name");
  }
  static_cast<void>(servo.statistics());
  try {
    const Channel other = Channel::attach(shared.channel.name());
    tegotae_shm_statistics statistics;
    static_cast<void>(other.read(statistics));
  } catch (const Error& e) {
    require(std::string(e.what()).find('\n') == std::string::npos, "the error is one line");
  }
}

}  // namespace

std::vector<Seed> seeds() {
  tegotae_shm_application payload{};
  payload.heartbeat_ns = kNow;
  payload.touching = 1;
  payload.orientation[0] = 1;
  payload.position[2] = 0.001;
  payload.stiffness = 800;
  payload.damping = 5;
  payload.torsional_stiffness = 0.3;
  payload.torsional_damping = 0.004;
  std::vector<Seed> all{{"good", slot_seed(payload)}};
  payload.stiffness = 1e308;
  payload.position[0] = -1e308;
  all.push_back({"huge", slot_seed(payload)});
  payload.orientation[0] = std::nan("");
  all.push_back({"not_a_number", slot_seed(payload)});
  payload.orientation[0] = 0;
  payload.stiffness = 800;
  all.push_back({"zero_quaternion", slot_seed(payload)});
  payload.heartbeat_ns = INT64_MIN;
  all.push_back({"old", slot_seed(payload)});
  all.push_back({"odd_counter", record(offsetof(tegotae_shm_segment, application_counter), std::string(8, '\x01'))});
  all.push_back({"pen", record(offsetof(tegotae_shm_segment, device_counter), std::string(200, '\xfe'))});
  all.push_back({"header", record(0, std::string(24, '\xff'))});
  return all;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Shared shared;
  static const tegotae_shm_segment fresh = [] {
    tegotae_shm_segment s;
    std::memcpy(&s, shared.bytes, sizeof s);
    return s;
  }();
  std::memcpy(shared.bytes, &fresh, sizeof fresh);
  OpenPen pen;
  const ServoSettings settings;
  Servo servo(pen, shared.channel, settings);
  const ContactLink link(shared.channel, {}, Vec3::Zero());
  look(shared, pen, servo, link, settings.safety.limits);
  while (size >= 3) {
    const std::size_t offset = (data[0] | std::size_t{data[1]} << 8) % sizeof fresh;
    const std::size_t length = std::min({std::size_t{data[2]}, size - 3, sizeof fresh - offset});
    std::memcpy(shared.bytes + offset, data + 3, length);
    data += 3 + length;
    size -= 3 + length;
    look(shared, pen, servo, link, settings.safety.limits);
  }
  return 0;
}

}  // namespace tegotae
