#include "transport/shared_memory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <utility>

#include "core/file_descriptor.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

namespace {

constexpr std::size_t kSize = sizeof(tegotae_shm_segment);

const std::string kUniqueName = "/tegotae-";  // then the process and a number

// Each try that fails means that another process created or removed the segment in between.
constexpr int kCreateAttempts = 100;

[[noreturn]] void fail(const std::string& name, const std::string& what) {
  throw Error(ErrorKind::device, "shared memory " + name + ": " + what);
}
[[noreturn]] void fail_errno(const std::string& name, const std::string& what) {
  fail(name, what + ": " + std::strerror(errno));
}

/// shm_open, above the standard descriptors.
FileDescriptor opened(const std::string& name, int how) {
  return FileDescriptor(above_standard(shm_open(name.c_str(), how | O_CLOEXEC, S_IRUSR | S_IWUSR)));
}

/// Sets the size, with memory for every page: one that is not there when it is written ends the process by SIGBUS.
void allocate(int fd, const std::string& name) {
  if (ftruncate(fd, kSize) != 0) fail_errno(name, "cannot be sized");
  int error = EINTR;
  while (error == EINTR) error = posix_fallocate(fd, 0, kSize);
  if (error != 0)
    fail(name, "no memory for its " + std::to_string(kSize) + " bytes: " + std::strerror(error) +
                   "; free some memory of /dev/shm");
}

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
  const FileDescriptor again = opened(name, O_RDONLY);
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
  const FileDescriptor fd = opened(name, O_RDWR);
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

bool is_unique_name(const std::string& name) {
  static const std::regex form(kUniqueName + "[0-9]+-[0-9]+");
  return std::regex_match(name, form);
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
    FileDescriptor fd = opened(name, O_RDWR | O_CREAT | O_EXCL);
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
      allocate(fd.get(), name);
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
  FileDescriptor fd = opened(name, role == SegmentRole::observer ? O_RDONLY : O_RDWR);
  if (fd.get() < 0 && errno == ENOENT) fail(name, "there is none; start its device first (`tegotae-device`)");
  if (fd.get() < 0) fail_errno(name, "cannot be opened");
  check_file(fd.get(), name);
  if (role == SegmentRole::application && !lock_byte(fd.get(), TEGOTAE_SHM_LOCK_APPLICATION))
    fail(name, "another application is attached");
  // A device of another maker may have set the size only.
  if (role == SegmentRole::application) allocate(fd.get(), name);
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
  return kUniqueName + std::to_string(getpid()) + "-" + std::to_string(count++);
}

void remove_left_segments() {
  std::error_code failed;  // where nothing can be listed nothing is removed
  for (std::filesystem::directory_iterator i("/dev/shm", failed), end; !failed && i != end; i.increment(failed)) {
    const std::string name = "/" + i->path().filename().string();
    if (!is_unique_name(name)) continue;
    const FileDescriptor fd = opened(name, O_RDWR | O_NONBLOCK);
    struct stat info;
    if (fd.get() < 0 || fstat(fd.get(), &info) != 0 || info.st_uid != geteuid()) continue;
    const std::uint64_t magic = read_header(fd.get()).magic;
    if (magic != TEGOTAE_SHM_MAGIC && magic != 0) continue;
    // A living owner has the lock; whoever gets it is the only one who may unlink.
    if (lock_byte(fd.get(), TEGOTAE_SHM_LOCK_DEVICE) && is_named(fd.get(), name)) shm_unlink(name.c_str());
  }
}

}  // namespace tegotae
