#include "device/shared_memory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <utility>

#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

namespace {

constexpr std::size_t kSize = sizeof(tegotae_shm_segment);

// Each try that fails means that another process created or removed the segment in between.
constexpr int kCreateAttempts = 100;

[[noreturn]] void fail(const std::string& name, const std::string& what) {
  throw Error("shared memory " + name + ": " + what);
}
[[noreturn]] void fail_errno(const std::string& name, const std::string& what) {
  fail(name, what + ": " + std::strerror(errno));
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
  int release() { return std::exchange(fd_, -1); }

 private:
  int fd_;
};

struct flock one_byte(short type, off_t byte) {
  struct flock lock {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  lock.l_start = byte;
  lock.l_len = 1;
  return lock;
}

// Locks of the open file description: the kernel drops them when the process dies, however it dies, and they cannot be
// mistaken for those of a later process with the same id.
bool lock_byte(int fd, off_t byte) {
  struct flock lock = one_byte(F_WRLCK, byte);
  return fcntl(fd, F_OFD_SETLK, &lock) == 0;
}

bool locked_by_another(int fd, off_t byte) {
  struct flock lock = one_byte(F_RDLCK, byte);
  return fcntl(fd, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

struct stat examined(int fd, const std::string& name) {
  struct stat info;
  if (fstat(fd, &info) != 0) fail_errno(name, "cannot be examined");
  return info;
}

/// Whether `name` still stands for what `fd` has open.
bool is_named(int fd, const std::string& name) {
  const FileDescriptor again(shm_open(name.c_str(), O_RDONLY | O_CLOEXEC, 0));
  struct stat a, b;
  return again.get() >= 0 && fstat(fd, &a) == 0 && fstat(again.get(), &b) == 0 && a.st_ino == b.st_ino;
}

/// The fields before the first slot, as far as the object has them; zeros otherwise.
struct Header {
  std::uint64_t magic;
  std::uint32_t version;
  std::uint32_t size;
  std::uint64_t owner_pid;
};
static_assert(offsetof(tegotae_shm_segment, owner_pid) == offsetof(Header, owner_pid));

Header read_header(int fd) {
  Header header{};
  if (pread(fd, &header, sizeof header, 0) < 0) return {};
  return header;
}

std::string process(const Header& header) {
  return "process " + std::to_string(header.owner_pid);
}

/// Unlinks what a dead process left under `name`. Throws when the name is in use.
void remove_stale(const std::string& name) {
  const FileDescriptor fd(shm_open(name.c_str(), O_RDWR | O_CLOEXEC, 0));
  if (fd.get() < 0) {
    if (errno == ENOENT) return;  // gone by now
    fail_errno(name, "the name is in use and cannot be opened");
  }
  if (examined(fd.get(), name).st_uid != geteuid()) fail(name, "the name is in use by another user");
  const Header header = read_header(fd.get());
  // The magic is stored last, so that zero is a segment whose creator died on the way.
  if (header.magic != TEGOTAE_SHM_MAGIC && header.magic != 0)
    fail(name, "the name is in use by something that is not a segment of this protocol; choose another name");
  // Whoever gets this lock is the only one who may unlink it.
  if (!lock_byte(fd.get(), TEGOTAE_SHM_LOCK_DEVICE))
    fail(name, "the name is in use by a device that is alive, " + process(header) + "; end it or choose another name");
  if (is_named(fd.get(), name)) shm_unlink(name.c_str());
}

/// When this process started, as in the header; 0 when not known.
std::uint64_t start_time() {
  std::ifstream file("/proc/self/stat");
  const std::string line(std::istreambuf_iterator<char>(file), {});
  std::size_t at = line.rfind(')');  // the program's name before it may hold spaces
  if (at == std::string::npos) return 0;
  for (int field = 2; field < 22 && at != std::string::npos; ++field) at = line.find(' ', at + 1);
  return at == std::string::npos ? 0 : std::strtoull(line.c_str() + at, nullptr, 10);
}

void check_file(int fd, const std::string& name) {
  const struct stat info = examined(fd, name);
  if (info.st_uid != geteuid()) fail(name, "belongs to another user");
  if ((info.st_mode & (S_IRWXG | S_IRWXO)) != 0) fail(name, "may be opened by other users");
  const Header header = read_header(fd);
  if (header.magic != TEGOTAE_SHM_MAGIC) fail(name, "is not a segment of this protocol, or not ready yet");
  if (header.version != TEGOTAE_SHM_VERSION)
    fail(name, "has protocol version " + std::to_string(header.version) + "; this library speaks version " +
                   std::to_string(TEGOTAE_SHM_VERSION));
  if (info.st_size != static_cast<off_t>(kSize))
    fail(name, "has " + std::to_string(info.st_size) + " bytes instead of " + std::to_string(kSize));
  if (header.size != kSize)
    fail(name, "says that it has " + std::to_string(header.size) + " bytes instead of " + std::to_string(kSize));
  if (!locked_by_another(fd, TEGOTAE_SHM_LOCK_DEVICE)) fail(name, "its device is gone; it was " + process(header));
}

}  // namespace

Segment::Segment(std::string name, int fd, SegmentRole role) : name_(std::move(name)), fd_(fd), role_(role) {
  const int protection = role == SegmentRole::observer ? PROT_READ : PROT_READ | PROT_WRITE;
  void* memory = mmap(nullptr, kSize, protection, MAP_SHARED, fd, 0);
  if (memory == MAP_FAILED) fail_errno(name_, "cannot be mapped");
  memory_ = static_cast<tegotae_shm_segment*>(memory);
}

std::unique_ptr<Segment> Segment::create(const std::string& name) {
  for (int attempt = 0; attempt < kCreateAttempts; ++attempt) {
    FileDescriptor fd(shm_open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR));
    if (fd.get() < 0) {
      if (errno != EEXIST) fail_errno(name, "cannot be created");
      remove_stale(name);
      continue;
    }
    // Between creating and locking another process may have taken it for stale.
    if (!lock_byte(fd.get(), TEGOTAE_SHM_LOCK_DEVICE) || !is_named(fd.get(), name)) continue;
    std::unique_ptr<Segment> segment;
    try {
      // Whatever the umask took away.
      if (fchmod(fd.get(), S_IRUSR | S_IWUSR) != 0) fail_errno(name, "cannot be protected");
      if (ftruncate(fd.get(), kSize) != 0) fail_errno(name, "cannot be sized");
      segment.reset(new Segment(name, fd.get(), SegmentRole::device));
    } catch (const Error&) {
      shm_unlink(name.c_str());
      throw;
    }
    fd.release();
    tegotae_shm_segment& memory = *segment->memory_;
    memory.version = TEGOTAE_SHM_VERSION;
    memory.size = kSize;
    memory.owner_pid = static_cast<std::uint64_t>(getpid());
    memory.owner_start = start_time();
    memory.created_ns = monotonic_ns();
    __atomic_store_n(&memory.magic, TEGOTAE_SHM_MAGIC, __ATOMIC_RELEASE);
    return segment;
  }
  fail(name, "several processes create it at once");
}

std::unique_ptr<Segment> Segment::open(const std::string& name, SegmentRole role) {
  const int access = role == SegmentRole::observer ? O_RDONLY : O_RDWR;
  FileDescriptor fd(shm_open(name.c_str(), access | O_CLOEXEC, 0));
  if (fd.get() < 0) fail_errno(name, "cannot be opened");
  check_file(fd.get(), name);
  if (role == SegmentRole::application && !lock_byte(fd.get(), TEGOTAE_SHM_LOCK_APPLICATION))
    fail(name, "another application is attached");
  std::unique_ptr<Segment> segment(new Segment(name, fd.get(), role));
  fd.release();
  return segment;
}

Segment::~Segment() {
  munmap(memory_, kSize);
  if (role_ == SegmentRole::device && is_named(fd_, name_)) shm_unlink(name_.c_str());
  close(fd_);
}

std::string unique_segment_name() {
  static std::atomic<unsigned> count{0};
  return "/tegotae-" + std::to_string(getpid()) + "-" + std::to_string(count++);
}

}  // namespace tegotae
