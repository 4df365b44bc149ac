#include "tegotae/record/recorder.hpp"

#include <atomic>
#include <chrono>
#include <cstdio>
#include <optional>
#include <thread>

#include "record/frame_ring.hpp"
#include "record/record_file.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

namespace {
// How long rows wait in the ring; at 1 kHz a small part of its default capacity.
constexpr std::chrono::milliseconds kDrainPeriod(10);
}  // namespace

struct Recorder::Impl {
  Impl(const std::string& path, const RecordingInfo& info) : file(open_record_file(path, info)) {}

  std::unique_ptr<RecordFile> file;
  std::optional<FrameRing> ring;  // threaded mode
  std::thread writer;
  std::atomic<bool> stopping{false};
  std::atomic<std::uint64_t> rows{0};
  std::atomic<std::uint64_t> dropped{0};
  bool open = true;

  void drain() noexcept {
    RecordFrame frame;
    while (ring->pop(frame)) file->add(frame);
    file->flush();
  }

  void write_until_stopped() noexcept {
    while (!stopping.load(std::memory_order_acquire)) {
      drain();
      std::this_thread::sleep_for(kDrainPeriod);
    }
    file->hurry();
    drain();
  }

  void close(const std::string& continued_by) {
    if (!open) return;
    open = false;
    if (writer.joinable()) {
      stopping.store(true, std::memory_order_release);
      writer.join();
    } else {
      file->hurry();
    }
    try {
      file->close(continued_by);
    } catch (const Error& e) {
      throw Error(e.kind(),
                  e.what() + std::string("; it has the first ") + std::to_string(file->written()) + " of " +
                      std::to_string(rows.load(std::memory_order_relaxed)) + " rows",
                  e.place());
    }
  }
};

Recorder::Recorder(const std::string& path, RecordMode mode, const RecordingInfo& info, std::size_t capacity)
    : impl_(std::make_unique<Impl>(path, info)) {
  if (mode == RecordMode::synchronous) return;
  if (capacity == 0) throw Error(ErrorKind::setting, path + ": a recorder needs a capacity of at least one frame");
  impl_->ring.emplace(capacity);
  impl_->writer = std::thread([impl = impl_.get()] { impl->write_until_stopped(); });
}

Recorder::~Recorder() {
  try {
    impl_->close({});
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
  }
}

void Recorder::push(const RecordFrame& frame) noexcept {
  if (!impl_->open) return;
  if (!impl_->ring) {
    impl_->file->add(frame);
  } else if (!impl_->ring->push(frame)) {
    impl_->dropped.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  impl_->rows.fetch_add(1, std::memory_order_relaxed);
}

void Recorder::close(const std::string& continued_by) {
  impl_->close(continued_by);
}

std::uint64_t Recorder::rows() const noexcept {
  return impl_->rows.load(std::memory_order_relaxed);
}
std::uint64_t Recorder::dropped() const noexcept {
  return impl_->dropped.load(std::memory_order_relaxed);
}

}  // namespace tegotae
