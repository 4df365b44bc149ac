#include "device/shared_memory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>

#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

namespace {

constexpr std::size_t kSize = sizeof(tegotae_shm_segment);

[[noreturn]] void fail(const std::string& name, const std::string& what) {
  throw Error("shared memory " + name + ": " + what);
}

class FileDescriptor {
 public:
  explicit FileDescriptor(int fd) : fd_(fd) {}
  ~FileDescriptor() {
    if (fd_ >= 0) close(fd_);
  }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
};

tegotae_shm_segment* mapped(int fd, const std::string& name) {
  void* memory = mmap(nullptr, kSize, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  if (memory == MAP_FAILED) fail(name, std::string("cannot be mapped: ") + std::strerror(errno));
  return static_cast<tegotae_shm_segment*>(memory);
}

}  // namespace

std::string unique_segment_name() {
  static std::atomic<unsigned> count{0};
  return "/tegotae-" + std::to_string(getpid()) + "-" + std::to_string(count++);
}

bool create_segment(const std::string& name, tegotae_shm_segment*& segment) {
  const FileDescriptor fd(shm_open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR));
  if (fd.get() < 0) {
    if (errno == EEXIST) return false;
    fail(name, std::string("cannot be created: ") + std::strerror(errno));
  }
  try {
    // Whatever the umask took away.
    if (fchmod(fd.get(), S_IRUSR | S_IWUSR) != 0)
      fail(name, std::string("cannot be protected: ") + std::strerror(errno));
    if (ftruncate(fd.get(), kSize) != 0) fail(name, std::string("cannot be sized: ") + std::strerror(errno));
    segment = mapped(fd.get(), name);
  } catch (const Error&) {
    unlink_segment(name);
    throw;
  }
  segment->version = TEGOTAE_SHM_VERSION;
  segment->size = kSize;
  segment->owner_pid = static_cast<std::uint64_t>(getpid());
  segment->created_ns = monotonic_ns();
  __atomic_store_n(&segment->magic, TEGOTAE_SHM_MAGIC, __ATOMIC_RELEASE);
  return true;
}

tegotae_shm_segment* attach_segment(const std::string& name) {
  const FileDescriptor fd(shm_open(name.c_str(), O_RDWR | O_CLOEXEC, 0));
  if (fd.get() < 0) fail(name, std::string("cannot be opened: ") + std::strerror(errno));
  struct stat info;
  if (fstat(fd.get(), &info) != 0) fail(name, std::string("cannot be examined: ") + std::strerror(errno));
  if (info.st_uid != geteuid()) fail(name, "belongs to another user");
  if ((info.st_mode & (S_IRWXG | S_IRWXO)) != 0) fail(name, "may be opened by other users");
  if (info.st_size != static_cast<off_t>(kSize))
    fail(name, "has " + std::to_string(info.st_size) + " bytes instead of " + std::to_string(kSize));
  tegotae_shm_segment* segment = mapped(fd.get(), name);
  std::string wrong;
  if (__atomic_load_n(&segment->magic, __ATOMIC_ACQUIRE) != TEGOTAE_SHM_MAGIC)
    wrong = "is not a segment of this protocol, or not ready yet";
  else if (segment->version != TEGOTAE_SHM_VERSION)
    wrong = "has protocol version " + std::to_string(segment->version) + "; this library speaks version " +
            std::to_string(TEGOTAE_SHM_VERSION);
  else if (segment->size != kSize)
    wrong = "says that it has " + std::to_string(segment->size) + " bytes instead of " + std::to_string(kSize);
  if (!wrong.empty()) {
    unmap_segment(segment);
    fail(name, wrong);
  }
  return segment;
}

void unmap_segment(tegotae_shm_segment* segment) noexcept {
  munmap(segment, kSize);
}

void unlink_segment(const std::string& name) noexcept {
  shm_unlink(name.c_str());
}

}  // namespace tegotae
