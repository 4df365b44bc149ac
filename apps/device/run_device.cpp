#include "device/run_device.hpp"

#include <signal.h>

#include <cstdio>

#include "device/make_device.hpp"
#include "device/status.hpp"
#include "shared/guarded_main.hpp"
#include "tegotae/coupling/stability.hpp"
#include "tegotae/servo/servo.hpp"
#include "tegotae/transport/channel.hpp"

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

/// Of the coupling that an application has set, or else of the default one.
std::string stability_text(const ChannelReader& channel, const DeviceInfo& info, double rate_hz) {
  CouplingSettings coupling;
  tegotae_shm_application a;
  if (channel.read(a) && a.enable != 0) coupling = {a.stiffness, a.damping, a.torsional_stiffness, a.torsional_damping};
  return stability(info, coupling, rate_hz).text();
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

/// Prints `now` when it is not what was shown last.
void show(const std::string& now, std::string& shown) {
  if (now == shown) return;
  std::printf("  %s\n", now.c_str());
  std::fflush(stdout);
  shown = now;
}

/// Prints state and stability whenever they change, until a signal comes.
void watch(const ChannelReader& channel, const DeviceInfo& info, double rate_hz, const EndSignals& signals) {
  std::string state, limits;
  do {
    show("stability: " + stability_text(channel, info, rate_hz), limits);
    tegotae_shm_device pen;
    if (channel.read(pen)) show(state_text(pen), state);
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
  watch(channel, device->info(), options.rate_hz, signals);
  servo.stop();
  device->stop();
  tegotae_shm_statistics statistics;
  if (channel.read(statistics)) std::fputs(statistics_text(statistics).c_str(), stdout);
  return kDone;
}

}  // namespace tegotae::apps
