#include "shared/open_browser.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

namespace tegotae::apps {
namespace {

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

// The shell returns at once: the program does not wait until the browser ends.
constexpr const char* kCommand = "command -v xdg-open >/dev/null && { xdg-open \"$1\" </dev/null >/dev/null 2>&1 & }";

}  // namespace

bool open_in_browser(const std::string& url) {
  if (!is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY")) return false;
  std::string shell = "sh", option = "-c", command = kCommand, name = "sh", argument = url;
  char* arguments[] = {shell.data(), option.data(), command.data(), name.data(), argument.data(), nullptr};
  posix_spawnattr_t attributes;
  if (posix_spawnattr_init(&attributes) != 0) return false;
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID);
  pid_t child = -1;
  const bool spawned = posix_spawn(&child, "/bin/sh", nullptr, &attributes, arguments, environ) == 0;
  posix_spawnattr_destroy(&attributes);
  int status = 0;
  return spawned && waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace tegotae::apps
