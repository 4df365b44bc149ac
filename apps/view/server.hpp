#pragma once

#include <memory>
#include <string>

#include "view/address.hpp"
#include "view/source.hpp"

namespace tegotae::view {

/// Serves the view page and its data from threads of its own (at low priority). Every request needs the token in url(),
/// this server as host and, where the browser sends an origin, this page as origin. Requests and clients are bounded; a
/// client that does not read is dropped.
class Server {
 public:
  /// Listens at once. Throws Error with the cause when it cannot. Keeps a reference to `source`.
  Server(const Address& address, ViewSource& source);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// The one address to open: http://127.0.0.1:PORT/?token=...
  const std::string& url() const;
  /// The same for one use, within a minute: it leads to url(). The token then does not stand in the command line of a
  /// browser, which everybody on the machine can read.
  std::string url_once() const;
  /// Whether a page has begun to watch.
  bool watched() const;
  /// What whoever opened the page to other machines should know, and where it is for them; empty on the loopback.
  std::string warning() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Most pages that may watch at the same time.
inline constexpr int kMaxWatchers = 8;

}  // namespace tegotae::view
