#include "view/server.hpp"

#include <civetweb.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"
#include "view/doorkeeper.hpp"
#include "view/request_guard.hpp"
#include "view/wire.hpp"
#include "web/page.hpp"

namespace tegotae::view {
namespace {

// Threads that serve; each watcher keeps one, the rest is for requests, and for strangers while the doorkeeper lets
// them. The servo locks their stacks into memory, so they are not many.
const std::string kThreads = std::to_string(kMaxWatchers + 12);
// Connections that wait for a thread where the doorkeeper sees them.
constexpr const char* kQueue = "200";
// CivetWeb gives up on a client that it waits for so long (ms) without a byte going either way.
constexpr const char* kTimeout = "10000";
constexpr std::size_t kMaxHeader = 8192;
constexpr std::size_t kMaxCommand = 2048;
// A quarter of an hour of a hand, 30 rows a second.
constexpr std::size_t kMaxScript = 4u << 20;
// A drag sends one a frame.
constexpr double kCommandsPerSecond = 200;
constexpr auto kFramePeriod = std::chrono::milliseconds(33);
constexpr std::int64_t kStatusNs = 500'000'000;
// The server's threads give way to everything else (nice).
constexpr int kNice = 10;

const char* or_empty(const char* text) {
  return text ? text : "";
}

void respond(mg_connection* connection, int status, const char* reason, const char* type, std::string_view body,
             const std::string& extra = {}) {
  std::string head =
      "HTTP/1.1 " + std::to_string(status) + " " + reason + "\r\nContent-Type: " + type +
      "\r\nContent-Length: " + std::to_string(body.size()) +
      "\r\nCache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\n" +
      // What could not be read to its end ends the connection.
      (status == 200 ? "" : "Connection: close\r\n") + extra + "\r\n";
  mg_write(connection, head.data(), head.size());
  mg_write(connection, body.data(), body.size());
}

/// So many at once, and so many a second.
class Rate {
 public:
  bool take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    const std::int64_t now = monotonic_ns();
    left_ = std::min(kCommandsPerSecond, left_ + 1e-9 * static_cast<double>(now - last_) * kCommandsPerSecond);
    last_ = now;
    if (left_ < 1) return false;
    left_ -= 1;
    return true;
  }

 private:
  std::mutex mutex_;
  double left_ = kCommandsPerSecond;
  std::int64_t last_ = monotonic_ns();
};

}  // namespace

struct Server::Impl {
  ViewSource& source;
  std::unique_ptr<RequestGuard> guard;
  std::string url, log;
  Address address;  ///< as asked for
  Address local;    ///< as seen from this machine
  std::atomic<int> watchers{0};
  std::atomic<bool> started{false}, ending{false}, watched{false};
  Rate rate;
  std::unique_ptr<Doorkeeper> door;
  mg_context* context = nullptr;

  explicit Impl(ViewSource& source_in) : source(source_in) {}

  int serve(mg_connection* connection) {
    const mg_request_info& request = *mg_get_request_info(connection);
    const std::string_view uri = or_empty(request.local_uri), method = or_empty(request.request_method);
    const bool page = uri == "/";
    char query[64] = "";
    if (page && request.query_string)
      mg_get_var(request.query_string, std::char_traits<char>::length(request.query_string), "token", query,
                 sizeof query);
    const RequestOrigin origin = {or_empty(mg_get_header(connection, "Host")),
                                  or_empty(mg_get_header(connection, "Origin")),
                                  or_empty(mg_get_header(connection, "Sec-Fetch-Site")),
                                  page ? query : or_empty(mg_get_header(connection, "X-Tegotae-Token"))};
    const std::string why = guard->refusal(origin);
    if (why.empty()) door->welcome(request.remote_port);
    if (!why.empty() && page && guard->take_once(origin)) {
      respond(connection, 303, "See Other", "text/plain; charset=utf-8", "",
              "Location: /?token=" + guard->token() + "\r\n");
    } else if (!why.empty()) {
      respond(connection, 403, "Forbidden", "text/plain; charset=utf-8", why + "\n");
    } else if (method == "GET" && page) {
      serve_page(connection);
    } else if (method == "GET" && uri == "/scene") {
      respond(connection, 200, "OK", "application/octet-stream", *source.scene());
    } else if (method == "GET" && uri == "/parts" && source.frames()) {
      respond(connection, 200, "OK", "application/json", source.parts());
    } else if (method == "GET" && uri == "/stream" && source.frames()) {
      serve_stream(connection);
    } else if (method == "GET" && uri == "/review") {
      serve_review(connection, {});
    } else if (method == "POST" && uri == "/review") {
      std::string script;
      if (read_body(connection, request.content_length, kMaxScript, script)) serve_review(connection, script);
    } else if (method == "POST" && uri == "/command") {
      serve_command(connection, request.content_length);
    } else {
      respond(connection, 404, "Not Found", "text/plain; charset=utf-8", "there is nothing here\n");
    }
    return 200;
  }

  void serve_page(mg_connection* connection) {
    // Scripts and styles are those of this answer, and the page speaks with this server only.
    const std::string nonce = random_hex(16);
    respond(connection, 200, "OK", "text/html; charset=utf-8", apps::view_page(nonce),
            "Content-Security-Policy: default-src 'none'; connect-src 'self'; img-src data: blob:; script-src 'nonce-" +
                nonce + "'; style-src 'nonce-" + nonce +
                "'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\nX-Frame-Options: DENY\r\n");
  }

  /// False without a body: too long or one request too many, which it answers, or incomplete because the client is
  /// gone.
  bool read_body(mg_connection* connection, long long length, std::size_t most, std::string& body) {
    constexpr const char* text = "text/plain; charset=utf-8";
    if (length < 0 || length > static_cast<long long>(most)) {
      respond(connection, 413, "Content Too Large", text, "at most " + std::to_string(most) + " bytes\n");
      return false;
    }
    if (!rate.take()) {
      respond(connection, 429, "Too Many Requests", text, "slower\n");
      return false;
    }
    body.assign(static_cast<std::size_t>(length), '\0');
    std::size_t got = 0;
    while (got < body.size()) {
      const int n = mg_read(connection, body.data() + got, body.size() - got);
      if (n <= 0) return false;
      got += static_cast<std::size_t>(n);
    }
    return true;
  }

  void serve_review(mg_connection* connection, const std::string& script) {
    constexpr const char* text = "text/plain; charset=utf-8";
    try {
      const std::string report = source.review(script);
      if (report.empty()) return respond(connection, 404, "Not Found", text, "there is nothing to report on\n");
      respond(connection, 200, "OK", "application/octet-stream", report);
    } catch (const Error& e) {
      respond(connection, 400, "Bad Request", text, std::string(e.what()) + "\n");
    }
  }

  void serve_command(mg_connection* connection, long long length) {
    constexpr const char* text = "text/plain; charset=utf-8";
    std::string body;
    if (!read_body(connection, length, kMaxCommand, body)) return;
    try {
      source.command(parse_command(body));
      respond(connection, 200, "OK", text, "");
    } catch (const Error& e) {
      respond(connection, 400, "Bad Request", text, std::string(e.what()) + "\n");
    } catch (const nlohmann::json::exception&) {
      respond(connection, 400, "Bad Request", text, "this is not a command\n");
    } catch (const std::exception& e) {
      respond(connection, 500, "Internal Server Error", text, std::string(e.what()) + "\n");
    }
  }

  void serve_stream(mg_connection* connection) {
    if (++watchers > kMaxWatchers)
      respond(connection, 503, "Service Unavailable", "text/plain; charset=utf-8", "too many pages are watching\n");
    else
      stream(connection);
    --watchers;
  }

  /// Frames and status until the client is gone: the newest frame at most every 33 ms, with the worst times since the
  /// one before.
  void stream(mg_connection* connection) {
    const std::string head =
        "HTTP/1.1 200 OK\r\nContent-Type: application/octet-stream\r\nCache-Control: no-store\r\n"
        "X-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n";
    if (mg_write(connection, head.data(), head.size()) <= 0) return;
    watched = true;
    const FrameRing& ring = *source.frames();
    FrameRing::Cursor cursor = ring.newest();
    std::uint64_t missed = 0;
    std::string last_status;
    std::int64_t status_ns = 0;
    for (; !ending; std::this_thread::sleep_for(kFramePeriod)) {
      std::string out;
      const std::string status = source.status();
      const std::int64_t now = monotonic_ns();
      // Also when there is nothing new: only a write finds out that the client is gone.
      if (status != last_status || now - status_ns > kStatusNs) {
        out += status_message(status);
        last_status = status;
        status_ns = now;
      }
      out += newest_frame(ring, cursor, missed);
      if (!out.empty() && mg_write(connection, out.data(), out.size()) != static_cast<int>(out.size())) return;
    }
  }

  static std::string newest_frame(const FrameRing& ring, FrameRing::Cursor& cursor, std::uint64_t& missed) {
    Frame frame, next;
    bool any = false;
    double tick_us = 0, late_us = std::nan("");
    while (ring.read(cursor, next, missed)) {
      tick_us = std::max(tick_us, next.tick_us);
      late_us = std::fmax(late_us, next.servo_late_us);
      frame = next;
      any = true;
    }
    if (!any) return {};
    frame.tick_us = tick_us;
    frame.servo_late_us = late_us;
    return frame_message(frame);
  }
};

Server::Server(const Address& address, ViewSource& source) : impl_(std::make_unique<Impl>(source)) {
  const std::string port = address.text();
  const std::string header = std::to_string(kMaxHeader);
  const char* options[] = {"listening_ports", port.c_str(), "num_threads", kThreads.c_str(), "request_timeout_ms",
                           kTimeout, "keep_alive_timeout_ms", "5000", "enable_keep_alive", "yes", "max_request_size",
                           header.c_str(), "tcp_nodelay", "1", "connection_queue", kQueue,
                           // Or it answers OPTIONS by itself, whoever asks, with "*".
                           "access_control_allow_methods", "", "access_control_allow_origin", "", nullptr};
  mg_callbacks callbacks{};
  callbacks.log_message = [](const mg_connection* connection, const char* message) {
    auto* impl = static_cast<Impl*>(mg_get_user_data(mg_get_context(connection)));
    if (impl && !impl->started) impl->log = message;  // later on a client's trouble is its own
    return 1;
  };
  callbacks.init_thread = [](const mg_context*, int) -> void* {
    setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNice);
    return nullptr;
  };
  impl_->context = mg_start(&callbacks, impl_.get(), options);
  if (!impl_->context) {
    const std::string why = why_not_listening(
        address, mg_check_feature(MG_FEATURES_IPV6) != 0);  // CivetWeb says no more than that it failed
    throw Error("cannot listen on " + port + ": " + (why.empty() ? impl_->log : why));
  }
  impl_->started = true;
  mg_server_port ports[2] = {};
  mg_get_server_ports(impl_->context, 2, ports);
  Address listening = address;
  listening.port = ports[0].port;
  impl_->guard = std::make_unique<RequestGuard>(listening);
  impl_->address = address;
  impl_->local = listening;
  if (address.wildcard()) impl_->local.host = address.host == "[::]" ? "[::1]" : "127.0.0.1";
  impl_->door = std::make_unique<Doorkeeper>(listening.port, impl_->guard->token());
  impl_->url = "http://" + impl_->local.text() + "/?token=" + impl_->guard->token();
  mg_set_request_handler(
      impl_->context, "**",
      [](mg_connection* connection, void* impl) { return static_cast<Impl*>(impl)->serve(connection); }, impl_.get());
}

// civetweb's listening thread looks whether it should stop when somebody calls, or every two seconds: so call.
Server::~Server() {
  impl_->ending = true;
  impl_->door->close();
  std::atomic<bool> stopped{false};
  std::thread caller([&] {
    const Address& a = impl_->local;
    const std::string host = a.host.front() == '[' ? a.host.substr(1, a.host.size() - 2) : a.host;
    while (!stopped) {
      char error[100];
      mg_connection* call = mg_connect_client(host.c_str(), a.port, 0, error, sizeof error);
      if (call) mg_close_connection(call);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  });
  mg_stop(impl_->context);
  stopped = true;
  caller.join();
}

const std::string& Server::url() const {
  return impl_->url;
}

std::string Server::url_once() const {
  return "http://" + impl_->local.text() + "/?token=" + impl_->guard->make_once();
}

bool Server::watched() const {
  return impl_->watched;
}

std::string Server::warning() const {
  const Address& a = impl_->address;
  const bool loopback = a.host.rfind("127.", 0) == 0 || a.host == "[::1]";
  if (loopback) return "";
  std::string text =
      "Anybody who can reach this machine can reach the page, and who listens on the network can read its token: it is "
      "plain "
      "HTTP. A tunnel is safer.";
  if (!a.wildcard()) return text;
  text += " From other machines it is at";
  for (const std::string& host : machine_addresses(a.host == "[::]"))
    text += " http://" + host + ":" + std::to_string(impl_->local.port) + "/?token=" + impl_->guard->token();
  return text + " .";
}

}  // namespace tegotae::view
