#include "tegotae/transport/attachment.hpp"

#include "tegotae/core/error.hpp"
#include "transport/shm_convert.hpp"

namespace tegotae {

namespace {

// A device that has been silent for so long is taken for lost: with a contact loop of 1 kHz it is noticed within 25 ms.
constexpr std::int64_t kSilenceNs = 20'000'000;
constexpr std::int64_t kPollNs = 100'000'000;

/// Name of the segment in "shm:NAME".
std::string segment_of(const std::string& device) {
  const std::string prefix = "shm:";
  if (device.rfind(prefix, 0) != 0 || device.size() == prefix.size())
    throw Error(ErrorKind::device,
                "unknown device " + device + "; give shm:NAME, the name of a running tegotae-device");
  return device.substr(prefix.size());
}

bool fresh(std::int64_t heartbeat_ns, std::int64_t now_ns) {
  std::int64_t age;
  return !__builtin_sub_overflow(now_ns, heartbeat_ns, &age) && age <= kSilenceNs && age >= -kSilenceNs;
}

}  // namespace

Attachment::Attachment(const std::string& device, const CouplingSettings& coupling, const Vec3& center, double scale)
    : name_(segment_of(device)), coupling_(coupling), center_(center), scale_(scale) {
  attach();
}

void Attachment::attach() {
  Channel channel = Channel::attach(name_);  // before the old one goes: it may throw
  link_.reset();
  channel_.emplace(std::move(channel));
  link_.emplace(*channel_, coupling_, center_);
  link_->set_scale(scale_);
  homed_ = false;
}

bool Attachment::read(PenSample& pen, std::int64_t now_ns) noexcept {
  PenSample newest;
  const bool there = link_->read(newest);
  if (there && fresh(newest.heartbeat_ns, now_ns)) {
    connected_ = true;
    if (!homed_ || !link_->obeyed(newest)) return false;
    pen = newest;
    return true;
  }
  // A device that has just been started has no heartbeat yet.
  if (connected_ && there) {
    connected_ = false;
    ++losses_;
  }
  poll_successor(now_ns);
  return false;
}

void Attachment::poll_successor(std::int64_t now_ns) noexcept {
  if (now_ns - polled_ns_ < kPollNs) return;
  polled_ns_ = now_ns;
  try {
    // While the old device lives, if silent, this application holds it and a second hold is refused.
    attach();
  } catch (const std::exception&) {  // none yet; connected() says so
  }
}

void Attachment::publish(const ProxyState& proxy, std::uint64_t tick, std::uint64_t device_sequence,
                         std::int64_t now_ns, const ContactPlanes& planes) noexcept {
  if (!homed_) link_->home(proxy.X);
  homed_ = true;
  link_->publish(proxy, tick, device_sequence, now_ns, planes);
}

void Attachment::grasp(const Vec3& center, const CouplingSettings& coupling, const Pose& X) noexcept {
  center_ = center;
  coupling_ = coupling;
  link_->grasp(center, coupling, X);
  homed_ = true;
}

ServoStatistics Attachment::statistics() const noexcept {
  return servo_statistics(*channel_);
}

}  // namespace tegotae
