#include "tegotae/device/channel.hpp"

#include <utility>

#include "device/shared_memory.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

namespace {

template <class Payload>
bool read_slot(const std::uint64_t& counter, const std::uint64_t* slot, Payload& payload) noexcept {
  Payload whole;
  if (tegotae_shm_read(&counter, slot, &whole, sizeof whole) == 0) return false;
  payload = whole;
  return true;
}

}  // namespace

Channel::Channel(std::string name, tegotae_shm_segment* segment, bool owner)
    : name_(std::move(name)), segment_(segment), owner_(owner) {}

Channel Channel::create(const std::string& name) {
  tegotae_shm_segment* segment = nullptr;
  if (!name.empty()) {
    if (!create_segment(name, segment)) throw Error("shared memory " + name + ": the name is in use");
    return {name, segment, true};
  }
  // A killed process may have had this process id and left its segments.
  std::string unique = unique_segment_name();
  while (!create_segment(unique, segment)) unique = unique_segment_name();
  return {unique, segment, true};
}

Channel Channel::attach(const std::string& name) {
  return {name, attach_segment(name), false};
}

Channel::~Channel() {
  if (segment_ == nullptr) return;
  unmap_segment(segment_);
  if (owner_) unlink_segment(name_);
}

Channel::Channel(Channel&& other) noexcept
    : name_(std::move(other.name_)), segment_(std::exchange(other.segment_, nullptr)), owner_(other.owner_) {}

Channel& Channel::operator=(Channel&& other) noexcept {
  std::swap(name_, other.name_);
  std::swap(segment_, other.segment_);
  std::swap(owner_, other.owner_);
  return *this;
}

void Channel::write(const tegotae_shm_device& payload) noexcept {
  tegotae_shm_write(&segment_->device_counter, segment_->device, &payload, sizeof payload);
}
void Channel::write(const tegotae_shm_application& payload) noexcept {
  tegotae_shm_write(&segment_->application_counter, segment_->application, &payload, sizeof payload);
}
void Channel::write(const tegotae_shm_statistics& payload) noexcept {
  tegotae_shm_write(&segment_->statistics_counter, segment_->statistics, &payload, sizeof payload);
}
bool Channel::read(tegotae_shm_device& payload) const noexcept {
  return read_slot(segment_->device_counter, segment_->device, payload);
}
bool Channel::read(tegotae_shm_application& payload) const noexcept {
  return read_slot(segment_->application_counter, segment_->application, payload);
}
bool Channel::read(tegotae_shm_statistics& payload) const noexcept {
  return read_slot(segment_->statistics_counter, segment_->statistics, payload);
}

}  // namespace tegotae
