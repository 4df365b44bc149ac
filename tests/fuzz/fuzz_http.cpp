// What a browser, or somebody who is none, sends to the view's server: the bytes of one connection. In the input `$T`
// stands for the server's token and `$H` for its host, which no fuzzer can guess.
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <nlohmann/json.hpp>

#include "fuzz/fuzz.hpp"
#include "tegotae/core/error.hpp"
#include "view/server.hpp"

namespace tegotae {

namespace {

/// Counts who gets through. It streams nothing: a stream ends with its watcher only.
class CountingSource final : public view::ViewSource {
 public:
  std::shared_ptr<const std::string> scene() const override {
    ++asked;
    return scene_;
  }
  const view::FrameRing* frames() const override { return nullptr; }
  std::string status() const override { return "{}"; }
  void command(const nlohmann::json& command) override {
    ++asked;
    if (!command.is_object()) throw Error("this is not an object");
  }
  std::string review(const std::string&) override {
    ++asked;
    return "<p>report</p>";
  }
  mutable std::atomic<int> asked{0};

 private:
  std::shared_ptr<const std::string> scene_ = std::make_shared<const std::string>("bundle");
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

/// Sends it all and closes its side; what came back.
std::string answer(int port, const std::string& bytes) {
  const int fd = socket(AF_INET, SOCK_STREAM, 0);
  require(fd >= 0, "there are sockets");
  const linger at_once = {1, 0};  // leaves no port waiting
  setsockopt(fd, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  require(connect(fd, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0, "the server accepts");
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t n = send(fd, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (n <= 0) break;  // the server has had enough
    sent += static_cast<std::size_t>(n);
  }
  shutdown(fd, SHUT_WR);
  std::string all, piece(65536, '\0');
  for (ssize_t n = 0; (n = recv(fd, piece.data(), piece.size(), 0)) > 0;)
    all.append(piece, 0, static_cast<std::size_t>(n));
  close(fd);
  return all;
}

std::string request(const std::string& what, const std::string& more = {}) {
  return what + " HTTP/1.1\r\nHost: $H\r\nX-Tegotae-Token: $T\r\n" + more + "\r\n";
}

}  // namespace

std::vector<Seed> seeds() {
  const std::string command = R"({"do":"pause"})";
  const std::string length = "Content-Length: " + std::to_string(command.size()) + "\r\n";
  return {{"scene", request("GET /scene")},
          {"page", "GET /?token=$T HTTP/1.1\r\nHost: $H\r\n\r\n"},
          {"review", request("GET /review", "Sec-Fetch-Site: same-origin\r\n")},
          {"command", request("POST /command", "Origin: http://$H\r\n" + length) + command},
          {"two", request("GET /scene") + request("POST /command", length) + command},
          {"chunked", request("POST /command", "Transfer-Encoding: chunked\r\n") + "e\r\n" + command + "\r\n0\r\n\r\n"},
          {"long_command", request("POST /command", "Content-Length: 99999999999999999999\r\n") + command},
          {"negative_command", request("POST /command", "Content-Length: -1\r\n") + command},
          {"no_token", "GET /scene HTTP/1.1\r\nHost: $H\r\n\r\n"},
          {"other_site", request("GET /scene", "Origin: http://example.org\r\nSec-Fetch-Site: cross-site\r\n")},
          {"other_host", "GET /scene HTTP/1.1\r\nHost: example.org\r\nX-Tegotae-Token: $T\r\n\r\n"},
          {"upgrade", request("GET /stream",
                              "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                              "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n")},
          {"odd_path", request("GET /%2e%2e/%00scene?token=%")},
          {"no_http", "\r\n\r\n\x16\x03\x01"}};
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static CountingSource source;
  static const view::Server server({"127.0.0.1", 0}, source);
  static const std::string host = server.url().substr(7, server.url().find('/', 7) - 7);
  static const int port = std::stoi(host.substr(host.find(':') + 1));
  static const std::string token = server.url().substr(server.url().find('=') + 1);
  const std::string input(reinterpret_cast<const char*>(data), size);
  const int before = source.asked;
  const std::string sent = replaced(replaced(input, "$T", token), "$H", host);
  const std::string text = answer(port, sent);
  // A fuzzer that sees comparisons learns the token all the same, and an error may repeat what was sent.
  if (sent.find(token) == std::string::npos) {
    require(source.asked == before, "nobody gets through without the token");
    require(text.find(token) == std::string::npos, "the token is not told");
  }
  return 0;
}

}  // namespace tegotae
