#include "view/doorkeeper.hpp"

#include <dirent.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <chrono>
#include <cstdlib>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "tegotae/core/clock.hpp"

namespace tegotae::view {
namespace {

constexpr std::chrono::milliseconds kPeriod(25);
constexpr std::int64_t kPatienceNs = 2'000'000'000, kShortNs = 100'000'000;
constexpr std::size_t kMany = 8;  // strangers

constexpr std::size_t kMaxHeader = 8192;  // of the server's

struct Open {
  int fd, remote_port;
};

/// Of either family, in the byte order of the machine; 0 when there is none.
int port_of(const sockaddr_storage& address) {
  if (address.ss_family == AF_INET) return ntohs(reinterpret_cast<const sockaddr_in&>(address).sin_port);
  if (address.ss_family == AF_INET6) return ntohs(reinterpret_cast<const sockaddr_in6&>(address).sin6_port);
  return 0;
}

/// The connections of this process to its own `port`, by the kernel's list: CivetWeb shows a connection only once its
/// request is there.
std::vector<Open> open_connections(int port) {
  std::vector<Open> found;
  const std::unique_ptr<DIR, int (*)(DIR*)> folder(opendir("/proc/self/fd"), closedir);
  while (const dirent* entry = folder ? readdir(folder.get()) : nullptr) {
    const int fd = std::atoi(entry->d_name);
    sockaddr_storage here{}, there{};
    socklen_t size = sizeof here;
    if (getsockname(fd, reinterpret_cast<sockaddr*>(&here), &size) != 0 || port_of(here) != port) continue;
    size = sizeof there;
    if (getpeername(fd, reinterpret_cast<sockaddr*>(&there), &size) == 0) found.push_back({fd, port_of(there)});
  }
  return found;
}

}  // namespace

Doorkeeper::Doorkeeper(int port, std::string token)
    : port_(port), token_(std::move(token)), thread_([this] { work(); }) {}

Doorkeeper::~Doorkeeper() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    over_ = true;
  }
  thread_.join();
}

void Doorkeeper::welcome(int remote_port) {
  const std::lock_guard<std::mutex> lock(mutex_);
  welcome_.insert(remote_port);
}

void Doorkeeper::close() {
  const std::lock_guard<std::mutex> lock(mutex_);
  closing_ = true;
}

void Doorkeeper::work() {
  for (;;) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (over_) return;
      look();
    }
    std::this_thread::sleep_for(kPeriod);
  }
}

bool Doorkeeper::brings_token(int fd) const {
  char bytes[kMaxHeader];
  const ssize_t n = recv(fd, bytes, sizeof bytes, MSG_PEEK | MSG_DONTWAIT);
  return n > 0 && std::string_view(bytes, static_cast<std::size_t>(n)).find(token_) != std::string_view::npos;
}

void Doorkeeper::look() {
  const std::vector<Open> open = open_connections(port_);
  const std::int64_t now = monotonic_ns();
  std::map<int, std::int64_t> strangers;
  std::set<int> known;
  for (const Open& o : open) {
    if (welcome_.count(o.remote_port) > 0 || brings_token(o.fd)) {
      known.insert(o.remote_port);
    } else {
      const auto before = since_.find(o.remote_port);
      strangers[o.remote_port] = before == since_.end() ? now : before->second;
    }
  }
  const std::int64_t patience = strangers.size() > kMany ? kShortNs : kPatienceNs;
  for (const Open& o : open) {
    const auto stranger = strangers.find(o.remote_port);
    const bool late = stranger != strangers.end() && now - stranger->second > patience;
    // The thread that reads from it sees its end, and closes it.
    if (late || closing_) shutdown(o.fd, SHUT_RDWR);
  }
  since_ = std::move(strangers);
  welcome_ = std::move(known);  // a port that is used again is a stranger's
}

}  // namespace tegotae::view
