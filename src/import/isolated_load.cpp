#include "tegotae/import/isolated_load.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <utility>

#include "core/deadline.hpp"
#include "import/load_cached.hpp"
#include "import/mesh_pipe.hpp"
#include "import/utf8.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"

extern char** environ;

namespace tegotae {
namespace {

// Texts longer than this are not a message of a helper.
constexpr std::uint64_t kLongestText = 100'000;
constexpr int kPipeBytes = 1 << 20;

[[noreturn]] void fail(const std::string& path, const std::string& why) {
  throw Error(ErrorKind::file, path + ": " + why, {path, 0, {}, {}});
}

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() { reset(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }
  void reset() {
    if (fd_ >= 0) close(std::exchange(fd_, -1));
  }

 private:
  int fd_;
};

/// A started helper; ends with the object.
class Helper {
 public:
  explicit Helper(pid_t pid) : pid_(pid) {}
  ~Helper() {
    if (pid_ > 0) end();
  }
  Helper(const Helper&) = delete;
  Helper& operator=(const Helper&) = delete;

  /// Kills it if it still runs; how it ended.
  std::string end() {
    kill(pid_, SIGKILL);
    int status = 0;
    const pid_t pid = std::exchange(pid_, 0);
    while (waitpid(pid, &status, 0) < 0) {
      if (errno != EINTR) return "ended";  // somebody else waits for this process's children
    }
    if (WIFSIGNALED(status)) return std::string("died: ") + strsignal(WTERMSIG(status));
    return "ended with code " + std::to_string(WEXITSTATUS(status));
  }

 private:
  pid_t pid_;
};

std::string text(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

std::string program(const std::string& helper) {
  if (helper.find('/') != std::string::npos) return helper;
  std::error_code none;
  const auto beside = std::filesystem::read_symlink("/proc/self/exe", none).parent_path() / helper;
  return std::filesystem::exists(beside, none) ? beside.string() : helper;
}

/// Starts the helper with `out` as its kMeshPipe, ordinary scheduling, no blocked signals and nothing else open.
pid_t start(const std::string& path, double unit, const IsolatedLoad& bounds, int out) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, out, kMeshPipe);
  posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, 2, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_t how;
  posix_spawnattr_init(&how);
  sigset_t no_signals;
  sigemptyset(&no_signals);
  posix_spawnattr_setsigmask(&how, &no_signals);
  const sched_param ordinary{};
  posix_spawnattr_setschedpolicy(&how, SCHED_OTHER);
  posix_spawnattr_setschedparam(&how, &ordinary);
  posix_spawnattr_setflags(&how, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSCHEDULER);
  std::string words[] = {program(bounds.helper), text(unit), text(bounds.megabytes), text(bounds.seconds), path};
  char* argv[] = {words[0].data(), words[1].data(), words[2].data(), words[3].data(), words[4].data(), nullptr};
  pid_t pid = 0;
  const int error = posix_spawnp(&pid, argv[0], &files, &how, argv, environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&how);
  if (error != 0) fail(path, "the loading program " + words[0] + " cannot be started: " + std::strerror(error));
  return pid;
}

/// What the helper sends, until `deadline_ns`.
class Reader {
 public:
  Reader(int fd, Helper& helper, const std::string& path, const IsolatedLoad& bounds)
      : fd_(fd),
        helper_(helper),
        path_(path),
        seconds_(bounds.seconds),
        deadline_ns_(deadline_after(monotonic_ns(), bounds.seconds)) {}

  void read_all(void* data, std::size_t size) {
    char* at = static_cast<char*>(data);
    while (size > 0) {
      wait();
      const ssize_t n = read(fd_, at, size);
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) fail(path_, std::string("the loading process cannot be read: ") + std::strerror(errno));
      if (n == 0) fail(path_, "cannot be loaded: the loading process " + helper_.end());
      at += n;
      size -= static_cast<std::size_t>(n);
    }
  }

 private:
  void wait() {
    for (;;) {
      const std::int64_t left_ns = deadline_ns_ - monotonic_ns();
      if (left_ns <= 0) {
        fail(path_, "not loaded within " + text(seconds_) + " s; the loading process was ended");
      }
      pollfd ready{fd_, POLLIN, 0};
      const int n = poll(&ready, 1, static_cast<int>(std::min<std::int64_t>(left_ns / 1'000'000 + 1, 1'000'000)));
      if (n > 0) return;
      if (n < 0 && errno != EINTR) fail(path_, std::string("poll failed: ") + std::strerror(errno));
    }
  }

  int fd_;
  Helper& helper_;
  const std::string& path_;
  double seconds_;
  std::int64_t deadline_ns_;
};

/// A process that a damaged file has taken over may send anything.
void require_sound(const TriangleMesh& mesh, const std::string& path) {
  const auto in_range = [&](const std::array<std::uint32_t, 3>& t) {
    return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return v < mesh.vertices.size(); });
  };
  if (mesh.triangles.empty() || !std::all_of(mesh.triangles.begin(), mesh.triangles.end(), in_range) ||
      !std::all_of(mesh.vertices.begin(), mesh.vertices.end(), [](const Vec3& p) { return p.allFinite(); })) {
    fail(path, "the loading process sent no usable mesh");
  }
}

TriangleMesh received(Reader& reader, const std::string& path, const IsolatedLoad& bounds) {
  MeshPipeHead head;
  reader.read_all(&head, sizeof head);
  if (head.magic != MeshPipeHead::kMagic) fail(path, "the loading program is of another version");
  if (head.text_bytes > kLongestText) fail(path, "the loading process sent no mesh");
  std::string text(head.text_bytes, '\0');
  reader.read_all(text.data(), text.size());
  if (head.failed != 0) throw Error(ErrorKind::file, text, {path, 0, {}, {}});
  const double bytes = static_cast<double>(head.note_bytes) + 24.0 * static_cast<double>(head.vertices) +
                       12.0 * static_cast<double>(head.triangles);
  if (bytes > 1e6 * bounds.megabytes) fail(path, "the loading process sent more than its memory bound");
  TriangleMesh mesh;
  mesh.name = std::move(text);
  std::string notes(head.note_bytes, '\0');
  reader.read_all(notes.data(), notes.size());
  std::istringstream lines(notes);
  for (std::string note; std::getline(lines, note);) mesh.notes.push_back(printable(note));
  mesh.vertices.resize(head.vertices);
  reader.read_all(mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec3));
  mesh.triangles.resize(head.triangles);
  reader.read_all(mesh.triangles.data(), mesh.triangles.size() * sizeof mesh.triangles[0]);
  require_sound(mesh, path);
  return mesh;
}

TriangleMesh read_isolated(const std::string& path, double unit_in_m, const IsolatedLoad& bounds) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) fail(path, std::string("no pipe to the loading process: ") + std::strerror(errno));
  fcntl(ends[0], F_SETPIPE_SZ, kPipeBytes);  // where it may not be so large, processes take turns more often
  const Descriptor in(ends[0]);
  Descriptor out(ends[1]);
  Helper helper(start(path, unit_in_m, bounds, out.get()));
  out.reset();
  Reader reader(in.get(), helper, path, bounds);
  return received(reader, path, bounds);
}

}  // namespace

TriangleMesh load_mesh_isolated(const std::string& path, double unit_in_m, const IsolatedLoad& bounds) {
  if (!(bounds.seconds > 0 && bounds.seconds <= 1e6)) fail(path, "the bound on its loading time must be positive");
  if (!(bounds.megabytes > 0 && bounds.megabytes <= 1e9))
    fail(path, "the bound on its loading memory must be positive");
  return load_cached(path, unit_in_m, [&] { return read_isolated(path, unit_in_m, bounds); });
}

}  // namespace tegotae
