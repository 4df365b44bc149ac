#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>

namespace tegotae::view {

/// Keeps strangers from taking the server's threads: a connection that has not brought a request with the token within
/// two seconds is ended, and within a tenth of one where many wait. The server that it watches is one of this process.
class Doorkeeper {
 public:
  /// `port`: where the server listens. Who has sent `token`, and waits for a thread to read it, is not a stranger.
  Doorkeeper(int port, std::string token);
  ~Doorkeeper();
  Doorkeeper(const Doorkeeper&) = delete;
  Doorkeeper& operator=(const Doorkeeper&) = delete;

  /// The connection from this port has brought the token. From any thread.
  void welcome(int remote_port);
  /// From now on every connection is ended at once, so that no thread waits for one.
  void close();

 private:
  void work();
  /// Ends connections that are over their time; a look at all that are open.
  void look();

  bool brings_token(int fd) const;

  const int port_;
  const std::string token_;
  std::mutex mutex_;
  std::set<int> welcome_;  // remote ports; of a server that is seen from several addresses they may coincide
  bool closing_ = false, over_ = false;
  std::map<int, std::int64_t> since_;  // the thread's own: when a stranger's remote port was first seen
  std::thread thread_;
};

}  // namespace tegotae::view
