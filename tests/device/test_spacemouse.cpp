// Against a stand-in for spacenavd, a process of its own on a UNIX socket.
#include <sys/socket.h>
#include <sys/un.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "catch.hpp"
#include "child_process.hpp"
#include "device/moving_pen.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/device/input_devices.hpp"

using namespace tegotae;
using test::ChildProcess;
using test::read_until;

namespace {

struct Event {
  std::int32_t words[8];
};
// The daemon's protocol: 0 and 6 axes and the time since the last, 1 (press) or 2 (release) and the button.
Event motion(int x, int y, int z, int rx, int ry, int rz) {
  return {{0, x, y, z, rx, ry, rz, 16}};
}
Event button(bool down, int number) {
  return {{down ? 1 : 2, number, 0, 0, 0, 0, 0, 0}};
}
// Orders to the stand-in itself.
const Event kHalfAnEvent{{-1}};
const Event kHangUp{{-2}};

/// Listens on a socket of its own; passes on the events it is given.
class FakeDaemon {
 public:
  explicit FakeDaemon(bool answers_handshake = true) {
    const std::string folder = std::filesystem::temp_directory_path().string();
    path_ = folder + "/tegotae_spnav_" + std::to_string(getpid());
    setenv("SPNAV_SOCKET", path_.c_str(), 1);
    if (pipe(orders_) != 0) throw std::runtime_error("pipe");
    process_ = std::make_unique<ChildProcess>([this, answers_handshake](auto say) {
      close(orders_[1]);
      const int listener = socket(AF_UNIX, SOCK_STREAM, 0);
      sockaddr_un address{};
      address.sun_family = AF_UNIX;
      path_.copy(address.sun_path, sizeof address.sun_path - 1);
      unlink(path_.c_str());
      if (bind(listener, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 || listen(listener, 1) != 0)
        return;
      say(1);
      for (;;) serve(accept(listener, nullptr, nullptr), answers_handshake);
    });
    process_->hear();
    close(orders_[0]);
  }
  ~FakeDaemon() {
    close(orders_[1]);
    process_.reset();
    unlink(path_.c_str());
    unsetenv("SPNAV_SOCKET");
  }
  void send(const Event& event) const { REQUIRE(write(orders_[1], &event, sizeof event) == sizeof event); }
  void kill() const { process_->kill(SIGKILL); }

 private:
  void serve(int client, bool answers_handshake) const {
    std::int32_t handshake;
    if (read(client, &handshake, sizeof handshake) != sizeof handshake) _exit(4);
    if (answers_handshake && write(client, &handshake, sizeof handshake) != sizeof handshake) _exit(4);
    Event event;
    while (read(orders_[0], &event, sizeof event) == sizeof event) {
      if (event.words[0] == kHangUp.words[0]) break;
      const std::size_t bytes = event.words[0] == kHalfAnEvent.words[0] ? sizeof event / 2 : sizeof event;
      if (write(client, &event, bytes) != static_cast<ssize_t>(bytes)) _exit(4);
    }
    close(client);
  }

  std::string path_;
  int orders_[2];
  std::unique_ptr<ChildProcess> process_;
};

bool rests(const DeviceState& s) {
  return s.velocity.v.norm() == 0 && s.velocity.w.norm() == 0;
}

}  // namespace

TEST_CASE("a SpaceMouse moves the pen along and about its axes", "[spacemouse]") {
  const FakeDaemon daemon(GENERATE(true, false));  // both generations of the daemon
  const std::unique_ptr<Device> pen = make_spacemouse();
  pen->start();
  CHECK(pen->status() == DeviceStatus::ready);
  CHECK(pen->reason() == ForceOff::no_force);
  CHECK(pen->info().force_freedom == 0);

  // What libspnav's own spnav_posrot_moveobj makes of an event, in a right-handed frame with y up and z toward the
  // user: (x, y, -z) and (rx, ry, -rz). Here z is up and y away.
  struct Case {
    Event event;
    Vec3 v, w;
  };
  const Case cases[] = {{motion(350, 0, 0, 0, 0, 0), Vec3(0.05, 0, 0), Vec3::Zero()},
                        {motion(0, 350, 0, 0, 0, 0), Vec3(0, 0, 0.05), Vec3::Zero()},
                        {motion(0, 0, 350, 0, 0, 0), Vec3(0, 0.05, 0), Vec3::Zero()},
                        {motion(0, 0, 0, 350, 0, 0), Vec3::Zero(), Vec3(0.8, 0, 0)},
                        {motion(0, 0, 0, 0, 350, 0), Vec3::Zero(), Vec3(0, 0, 0.8)},
                        {motion(0, 0, 0, 0, 0, 350), Vec3::Zero(), Vec3(0, 0.8, 0)},
                        {motion(-2'000'000'000, 0, 0, 0, 0, 0), Vec3(-0.05, 0, 0), Vec3::Zero()}};
  for (const Case& c : cases) {
    daemon.send(c.event);
    CHECK(read_until(*pen, [&](const DeviceState& s) {
      return (s.velocity.v - c.v).norm() < 1e-9 && (s.velocity.w - c.w).norm() < 1e-9;
    }));
  }
  daemon.send(motion(0, 0, 0, 0, 0, 0));
  CHECK(read_until(*pen, rests));
  daemon.send(button(true, 1));
  CHECK(read_until(*pen, [](const DeviceState& s) { return s.buttons == 2; }));
  daemon.send(button(false, 1));
  CHECK(read_until(*pen, [](const DeviceState& s) { return s.buttons == 0; }));
  daemon.send(button(true, 77));
  daemon.send(button(true, 0));
  CHECK(read_until(*pen, [](const DeviceState& s) { return s.buttons == 1; }));
  pen->stop();
  CHECK(pen->status() == DeviceStatus::uninitialized);
}

TEST_CASE("without an application the pen of a SpaceMouse stays", "[spacemouse]") {
  const FakeDaemon daemon;
  const std::unique_ptr<Device> pen = make_spacemouse();
  pen->start();
  daemon.send(motion(350, 0, 0, 0, 0, 0));
  REQUIRE(read_until(*pen, [](const DeviceState& s) { return !rests(s); }));
  const Vec3 before = pen->read().pose.p;
  for (int i = 0; i < 20; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    CHECK(rests(pen->read()));
  }
  CHECK(pen->read().pose.p == before);
}

TEST_CASE("a daemon that dies stops the pen, one that comes back moves it again", "[spacemouse]") {
  auto daemon = std::make_unique<FakeDaemon>();
  const std::unique_ptr<Device> pen = make_spacemouse();
  pen->start();
  daemon->send(motion(350, 0, 0, 0, 0, 0));
  REQUIRE(read_until(*pen, [](const DeviceState& s) { return !rests(s); }));
  SECTION("killed") {
    daemon->kill();
    daemon.reset();
  }
  SECTION("hung up") {
    daemon->send(kHangUp);
  }
  CHECK(read_until(*pen, rests));
  CHECK(read_until(*pen, [&](const DeviceState&) { return pen->reason() == ForceOff::disconnected; }));
  if (!daemon) daemon = std::make_unique<FakeDaemon>();
  CHECK(read_until(*pen, [&](const DeviceState&) { return pen->reason() == ForceOff::no_force; }));
  daemon->send(motion(0, 350, 0, 0, 0, 0));
  CHECK(read_until(*pen, [](const DeviceState& s) { return s.velocity.v.z() > 0.04; }));
}

TEST_CASE("half an event holds up neither a read nor a stop", "[spacemouse]") {
  const FakeDaemon daemon;
  const std::unique_ptr<Device> pen = make_spacemouse();
  pen->start();
  daemon.send(motion(350, 0, 0, 0, 0, 0));
  REQUIRE(read_until(*pen, [](const DeviceState& s) { return !rests(s); }));
  daemon.send(kHalfAnEvent);
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  pen->set_tracking_error({});
  CHECK_FALSE(rests(pen->read()));
  pen->stop();
  CHECK(pen->status() == DeviceStatus::uninitialized);
}

TEST_CASE("without the daemon the message says what to start", "[spacemouse]") {
  setenv("SPNAV_SOCKET", "/nonexistent/spnav", 1);
  CHECK_THROWS_WITH(make_spacemouse()->start(), Catch::Contains("spacenavd"));
  unsetenv("SPNAV_SOCKET");
}
