#include "device/run_device.hpp"

#include <signal.h>

#include <cstdio>

#include "device/make_device.hpp"
#include "device/status.hpp"
#include "run_options.hpp"
#include "tegotae/device/channel.hpp"
#include "tegotae/servo/servo.hpp"

namespace tegotae::apps {

namespace {

constexpr timespec kLook = {0, 100'000'000};  // how often the state is looked at for the terminal

/// Signals that end the program are waited for, not handled: blocked in this thread and those it starts.
class EndSignals {
 public:
  EndSignals() {
    sigemptyset(&set_);
    for (int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&set_, signal);
    pthread_sigmask(SIG_BLOCK, &set_, nullptr);
  }
  bool came_within(const timespec& time) const { return sigtimedwait(&set_, nullptr, &time) > 0; }

 private:
  sigset_t set_;
};

ServoSettings servo_settings(const DeviceOptions& options) {
  ServoSettings settings;
  settings.rate_hz = options.rate_hz;
  settings.cpu = options.cpu;
  settings.realtime = options.enforce ? RealtimeConfig::enforce : RealtimeConfig::ignore;
  if (options.clutch_button >= 0) settings.mapping.clutch_buttons = 1u << options.clutch_button;
  if (options.dead_man_button >= 0) settings.safety.dead_man_buttons = 1u << options.dead_man_button;
  return settings;
}

void greet(const DeviceOptions& options, const ChannelReader& channel, const DeviceInfo& info,
           const RealtimeReport& realtime) {
  std::printf("%s: %s, process %llu, servo at %g Hz\n", channel.name().c_str(), info.name.c_str(),
              static_cast<unsigned long long>(channel.owner_pid()), options.rate_hz);
  std::printf("  real time: %s\n",
              realtime.missing.empty() ? "granted" : ("not all granted: " + realtime.missing).c_str());
  std::printf("  attach:    tegotae run SCENE --device shm:%s\n", channel.name().c_str() + 1);
  std::fflush(stdout);
}

/// Prints the state whenever it is another one, until a signal comes.
void watch(const ChannelReader& channel, const EndSignals& signals) {
  std::string shown;
  do {
    tegotae_shm_device pen;
    if (!channel.read(pen)) continue;
    const std::string now = state_text(pen);
    if (now == shown) continue;
    std::printf("  %s\n", now.c_str());
    std::fflush(stdout);
    shown = now;
  } while (!signals.came_within(kLook));
}

}  // namespace

int run_device(const DeviceOptions& options) {
  const EndSignals signals;
  const std::unique_ptr<Device> device = make_device(options);
  // The name first: a second device must not touch hardware that another process drives.
  Channel channel = Channel::create(options.name);
  device->start();
  Servo servo(*device, channel, servo_settings(options));
  servo.start();
  greet(options, channel, device->info(), servo.realtime());
  watch(channel, signals);
  servo.stop();
  device->stop();
  tegotae_shm_statistics statistics;
  if (channel.read(statistics)) std::fputs(statistics_text(statistics).c_str(), stdout);
  return kDone;
}

}  // namespace tegotae::apps
