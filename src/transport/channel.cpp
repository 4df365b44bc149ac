#include "tegotae/transport/channel.hpp"

#include "transport/shared_memory.hpp"

namespace tegotae {

namespace {

template <class Payload>
bool read_slot(const std::uint64_t& counter, const std::uint64_t* slot, Payload& payload) noexcept {
  Payload whole;
  if (tegotae_shm_read(&counter, slot, &whole, sizeof whole) == 0) return false;
  payload = whole;
  return true;
}

std::string with_slash(const std::string& name) {
  return name.empty() || name.front() == '/' ? name : "/" + name;
}

}  // namespace

ChannelReader::ChannelReader(std::unique_ptr<Segment> segment) : segment_(std::move(segment)) {}
ChannelReader::~ChannelReader() = default;
ChannelReader::ChannelReader(ChannelReader&&) noexcept = default;
ChannelReader& ChannelReader::operator=(ChannelReader&&) noexcept = default;

ChannelReader ChannelReader::open(const std::string& name) {
  return ChannelReader(Segment::open(with_slash(name), SegmentRole::observer));
}

Channel Channel::create(const std::string& name) {
  remove_left_segments();
  return Channel(Segment::create(name.empty() ? unique_segment_name() : with_slash(name)));
}

Channel Channel::attach(const std::string& name) {
  return Channel(Segment::open(with_slash(name), SegmentRole::application));
}

const std::string& ChannelReader::name() const noexcept {
  return segment_->name();
}
std::uint64_t ChannelReader::owner_pid() const noexcept {
  return segment_->memory()->owner_pid;
}
std::int64_t ChannelReader::created_ns() const noexcept {
  return segment_->memory()->created_ns;
}

bool ChannelReader::read(tegotae_shm_device& payload) const noexcept {
  return read_slot(segment_->memory()->device_counter, segment_->memory()->device, payload);
}
bool ChannelReader::read(tegotae_shm_application& payload) const noexcept {
  return read_slot(segment_->memory()->application_counter, segment_->memory()->application, payload);
}
bool ChannelReader::read(tegotae_shm_statistics& payload) const noexcept {
  return read_slot(segment_->memory()->statistics_counter, segment_->memory()->statistics, payload);
}

void Channel::write(const tegotae_shm_device& payload) noexcept {
  tegotae_shm_segment& s = *segment_->memory();
  tegotae_shm_write(&s.device_counter, s.device, &payload, sizeof payload);
}
void Channel::write(const tegotae_shm_application& payload) noexcept {
  tegotae_shm_segment& s = *segment_->memory();
  tegotae_shm_write(&s.application_counter, s.application, &payload, sizeof payload);
}
void Channel::write(const tegotae_shm_statistics& payload) noexcept {
  tegotae_shm_segment& s = *segment_->memory();
  tegotae_shm_write(&s.statistics_counter, s.statistics, &payload, sizeof payload);
}

}  // namespace tegotae
