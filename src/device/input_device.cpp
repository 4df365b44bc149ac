#include "device/input_device.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <thread>

#include "device/mailbox.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

namespace {

// A servo that was held up for longer does not make up for it.
constexpr std::int64_t kMaxStepNs = 20'000'000;
constexpr std::chrono::milliseconds kRetry(500);
constexpr std::chrono::milliseconds kRetryStep(10);  // in which a stop is noticed

/// InputState as words.
struct Message {
  double linear[3], angular[3];
  std::uint64_t buttons;
};

class InputDevice final : public Device {
 public:
  InputDevice(const std::string& name, std::unique_ptr<InputDriver> source, const RateControlSettings& settings)
      : name_(name), source_(std::move(source)), control_(settings) {}
  ~InputDevice() override { stop(); }

  DeviceInfo info() const override {
    DeviceInfo info;
    info.name = name_;
    info.force_freedom = 0;
    info.limits = {0, 0};
    info.continuous_force = 0;
    info.friction = 0;
    info.position_resolution = 0;
    return info;
  }

  void start() override {
    if (thread_.joinable()) return;
    stopping_ = false;
    std::promise<void> opened;
    std::future<void> result = opened.get_future();
    thread_ = std::thread([this, promise = std::move(opened)]() mutable { listen(promise); });
    try {
      result.get();
    } catch (...) {
      thread_.join();
      throw;
    }
    last_read_ns_ = monotonic_ns();
  }

  void stop() override {
    if (!thread_.joinable()) return;
    stopping_ = true;
    thread_.join();
  }

  DeviceState read() noexcept override {
    const std::int64_t now = monotonic_ns();
    const double dt = 1e-9 * static_cast<double>(std::clamp<std::int64_t>(now - last_read_ns_, 0, kMaxStepNs));
    last_read_ns_ = now;
    Message message{};
    messages_.read(message);
    if (led_ && connected_.load(std::memory_order_relaxed))
      control_.step({Vec3(message.linear), Vec3(message.angular)}, dt, lead_);
    else
      control_.rest();
    led_ = false;
    return {control_.pose(), control_.velocity(), static_cast<std::uint32_t>(message.buttons), now, sequence_++};
  }

  void write(const Wrench&) noexcept override {}
  void set_tracking_error(const Displacement& lead) noexcept override {
    lead_ = lead;
    led_ = true;
  }

  DeviceStatus status() const noexcept override {
    return thread_.joinable() ? DeviceStatus::ready : DeviceStatus::uninitialized;
  }
  ForceOff reason() const noexcept override {
    return connected_.load(std::memory_order_relaxed) ? ForceOff::no_force : ForceOff::disconnected;
  }

 private:
  void send(const InputState& state) noexcept {
    Message message{};
    for (int i = 0; i < 3; ++i) {
      message.linear[i] = state.deflection.linear[i];
      message.angular[i] = state.deflection.angular[i];
    }
    message.buttons = state.buttons;
    messages_.write(message);
  }

  void listen(std::promise<void>& opened) {
    try {
      source_->open();
    } catch (...) {
      opened.set_exception(std::current_exception());
      return;
    }
    connected_ = true;
    opened.set_value();
    InputState state;
    while (!stopping_) {
      if (source_->poll(state)) {
        send(state);
        continue;
      }
      connected_ = false;
      source_->close();
      state = {};
      send(state);
      retry();
    }
    connected_ = false;
    source_->close();
  }

  void retry() {
    while (!stopping_ && !connected_) {
      for (auto waited = kRetryStep; waited < kRetry && !stopping_; waited += kRetryStep)
        std::this_thread::sleep_for(kRetryStep);
      try {
        source_->open();
        connected_ = true;
      } catch (const Error&) {  // not yet; reason() says that it is gone
      }
    }
  }

  std::string name_;
  std::unique_ptr<InputDriver> source_;  // the thread's
  std::thread thread_;
  std::atomic<bool> stopping_{false};
  std::atomic<bool> connected_{false};
  Mailbox<Message> messages_;

  // The servo's.
  RateControl control_;
  Displacement lead_;
  bool led_ = false;
  std::int64_t last_read_ns_ = 0;
  std::uint64_t sequence_ = 0;
};

}  // namespace

std::unique_ptr<Device> make_input_device(const std::string& name, std::unique_ptr<InputDriver> source,
                                          const RateControlSettings& settings) {
  return std::make_unique<InputDevice>(name, std::move(source), settings);
}

}  // namespace tegotae
