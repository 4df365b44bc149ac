#include <fcntl.h>
#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/statfs.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "core/output_file.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

namespace fs = std::filesystem;

namespace {

// As the system follows.
constexpr int kMostLinks = 40;

/// Whether the file is one of those that a process lists as its own, as /dev/stdout is.
bool in_proc(const fs::path& path) {
  struct statfs system {};
  const std::string folder = (path.parent_path() / ".").string();
  return ::statfs(folder.c_str(), &system) == 0 && system.f_type == PROC_SUPER_MAGIC;
}

/// The file that `path` leads to over symbolic links, or would; empty where it can only be written into: what is no
/// file, or a descriptor of this process, whose other writers would keep the old one.
fs::path replaced_by_rename(const std::string& path) {
  std::error_code failed;
  fs::path at = path;
  for (int links = 0; links < kMostLinks; ++links) {
    if (in_proc(at)) return {};
    const fs::path to = fs::read_symlink(at, failed);
    if (failed) break;
    at = at.parent_path() / to;
  }
  const fs::file_status there = fs::status(at, failed);
  return fs::is_regular_file(there) || there.type() == fs::file_type::not_found ? at : fs::path();
}

/// Beside `target`, and no other process's or thread's.
std::string partial_of(const fs::path& target) {
  static std::atomic<int> count{0};
  char host[HOST_NAME_MAX + 1] = {};
  if (::gethostname(host, sizeof host - 1) != 0) host[0] = '\0';
  const std::string name =
      "." + std::string(host) + "-" + std::to_string(::getpid()) + "-" + std::to_string(++count) + ".partial";
  return (target.parent_path() / name).string();
}

/// What may be done with the file that stands there is what may be done with the new one.
void keep_rights(const struct stat& there, const std::string& partial) {
  // Only root can give a file away; what fails leaves what the process writes everywhere.
  if (::chown(partial.c_str(), there.st_uid, there.st_gid) != 0) errno = 0;
  if (::chmod(partial.c_str(), there.st_mode & 0777) != 0) errno = 0;
}

[[noreturn]] void fail(const std::string& path, const char* what, const std::string& why) {
  throw Error(ErrorKind::file, path + ": cannot be " + what + ": " + why, {path, 0, {}, {}});
}

void write_into(const std::string& path, std::string_view bytes) {
  OutputFile file(path);
  file.hurry();
  file.write(bytes);
  file.close();
}

}  // namespace

void write_file(const std::string& path, std::string_view bytes) {
  const fs::path target = replaced_by_rename(path);
  if (target.empty()) return write_into(path, bytes);
  // A file that is not to be written into is not to be replaced either.
  if (::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0 && errno != ENOENT)
    fail(path, "written", std::strerror(errno));
  write_file_by(partial_of(target), target.string(), bytes);
}

void write_file_by(const std::string& partial, const std::string& path, std::string_view bytes) {
  OutputFile file(partial, path);
  file.write(bytes);
  try {
    file.close();
    struct stat there {};
    if (::stat(path.c_str(), &there) == 0) keep_rights(there, partial);
    if (::rename(partial.c_str(), path.c_str()) != 0) fail(path, "written", std::strerror(errno));
  } catch (const Error&) {
    ::unlink(partial.c_str());
    throw;
  }
}

void make_folder(const std::string& path) {
  std::error_code failed;
  fs::create_directories(path, failed);
  if (failed) fail(path, "made", failed.message());
}

}  // namespace tegotae
