#include "study/driver.hpp"

#include <arpa/inet.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <thread>

#include "core/file_descriptor.hpp"
#include "core/output_file.hpp"
#include "shared/guarded_main.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::study {
namespace {

namespace fs = std::filesystem;

// How often a shard is begun again whose process was killed.
const char* const kRetries = "9";
// What is asked to end has this long, s.
constexpr double kPatience = 10;
// Files in the driver's folder; beside a database stand others whose names begin with its own.
const char *const kTasks = "tasks", *const kLog = "log", *const kDatabase = "tasks.db";

/// The first of `names` on PATH; empty: none.
std::string on_path(std::initializer_list<const char*> names) {
  const char* path = std::getenv("PATH");
  for (const char* name : names) {
    std::istringstream folders(path == nullptr ? "" : path);
    for (std::string folder; std::getline(folders, folder, ':');) {
      const fs::path file = fs::path(folder.empty() ? "." : folder) / name;
      if (::access(file.c_str(), X_OK) == 0 && fs::is_regular_file(file)) return file.string();
    }
  }
  return "";
}

/// For a shell: in quotes.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string this_program() {
  std::error_code failed;
  const fs::path self = fs::read_symlink("/proc/self/exe", failed);
  if (failed) throw Error("/proc/self/exe: cannot be read: " + failed.message());
  return self.string();
}

/// A port that was free a moment ago.
int free_port() {
  const FileDescriptor fd(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* const any = reinterpret_cast<sockaddr*>(&address);
  if (fd.get() < 0 || ::bind(fd.get(), any, size) != 0 || ::getsockname(fd.get(), any, &size) != 0)
    throw Error(std::string("no port for the driver: ") + std::strerror(errno));
  return ntohs(address.sin_port);
}

/// A line a shard.
std::string task_lines(const DriverJob& job) {
  const std::string start = quoted(this_program()) + " study " + quoted(fs::absolute(job.study).string()) + " --out " +
                            quoted(fs::absolute(job.out).string()) + " --jobs 1" + (job.trusted ? " --trusted" : "") +
                            " --shard ";
  std::string text;
  for (const Shard& shard : job.shards)
    text += start + std::to_string(shard.index + 1) + "/" + std::to_string(shard.count) + "\n";
  return text;
}

/// Starts the program in a process group of its own, so that one signal stops all of it.
pid_t start(const std::vector<std::string>& command, const std::string& log) {
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const pid_t child = ::fork();
  if (child < 0) throw Error(std::string("the driver cannot be started: ") + std::strerror(errno));
  // By both, so that neither goes on before.
  ::setpgid(child, child);
  if (child > 0) return child;
  if (std::freopen(log.c_str(), "w", stderr) == nullptr || std::freopen("/dev/null", "w", stdout) == nullptr ||
      std::freopen("/dev/null", "r", stdin) == nullptr)
    ::_exit(126);
  ::execv(arguments.front(), arguments.data());
  ::_exit(127);
}

/// Waits for it; Ctrl-C is handed on. Its status.
int wait_for(pid_t child, const std::atomic<bool>& interrupted) {
  bool told = false;
  for (int status = 0;;) {
    const pid_t ended = ::waitpid(child, &status, WNOHANG);
    if (ended == child) return status;
    if (ended < 0 && errno != EINTR) throw Error(std::string("the driver is lost: ") + std::strerror(errno));
    if (interrupted && !told) {
      ::kill(-child, SIGTERM);
      told = true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

/// Waits until what the driver started has ended too, after Ctrl-C.
void wait_for_group(pid_t group) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(kPatience);
  while (::kill(-group, 0) == 0 && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  ::kill(-group, SIGKILL);
}

/// Removes what an earlier call left in the driver's folder, and nothing else: it may have been there before.
void remove_earlier(const fs::path& folder) {
  std::error_code failed;  // what is done is in the shards
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    const std::string name = entry.path().filename().string();
    if (name == kTasks || name == kLog || name.rfind(kDatabase, 0) == 0) fs::remove(entry.path(), failed);
  }
}

}  // namespace

std::string find_driver(const std::string& study) {
  const std::string found = on_path({"hs", "hyper-shell"});
  if (!found.empty()) return found;
  throw Error(
      "study run needs HyperShell (`pip install hypershell`), whose program hs is not on PATH; without it `tegotae "
      "study " +
      study + "` makes all cases in one process, and with --shard I/N a part of them");
}

bool drive(const std::string& driver, const DriverJob& job) {
  const fs::path folder = fs::path(job.out) / "driver";
  remove_earlier(folder);
  make_folder(folder.string());
  const std::string tasks = (folder / kTasks).string(), log = (folder / kLog).string();
  write_file(tasks, task_lines(job));
  const int processors = job.processors > 0 ? job.processors : static_cast<int>(std::thread::hardware_concurrency());
  ::setenv("HYPERSHELL_DATABASE_FILE", fs::absolute(folder / kDatabase).c_str(), 1);
  const std::vector<std::string> command = {
      driver, "cluster", tasks, "-N", std::to_string(processors), "-p", std::to_string(free_port()), "-r", kRetries,
      "-w",   "1",       "-Q",  "1"};
  const std::atomic<bool>& interrupted = apps::catch_interrupts();
  const pid_t child = start(command, log);
  const int status = wait_for(child, interrupted);
  if (interrupted) {
    wait_for_group(child);
    return false;
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw Error(driver + " failed (" +
                (WIFEXITED(status) ? "exit code " + std::to_string(WEXITSTATUS(status))
                                   : "signal " + std::to_string(WTERMSIG(status))) +
                "); what it says is in " + log + ". What is finished is kept");
  return true;
}

}  // namespace tegotae::study
