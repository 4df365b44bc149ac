// Plain sockets against a program that serves its page.
#pragma once

#include <arpa/inet.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/run_program.hpp"

namespace tegotae::test {

/// A program of the build's bin folder that serves a page; killed with the object.
class Served {
 public:
  explicit Served(std::vector<std::string> arguments) {
    arguments[0] = std::string(TEGOTAE_BIN_DIR "/") + arguments[0];
    child_ = ::fork();
    if (child_ == 0) {
      const int out = ::open((folder_ / "out").c_str(), O_CREAT | O_WRONLY, 0600);
      const int err = ::open((folder_ / "err").c_str(), O_CREAT | O_WRONLY, 0600);
      ::dup2(out, STDOUT_FILENO);
      ::dup2(err, STDERR_FILENO);
      std::vector<char*> argv;
      for (std::string& a : arguments) argv.push_back(a.data());
      argv.push_back(nullptr);
      ::execv(argv[0], argv.data());
      ::_exit(127);
    }
    for (int i = 0; i < 600 && url().empty(); ++i) ::usleep(50'000);
    if (url().empty()) throw std::runtime_error("no address: " + read_text(folder_ / "err"));
    const std::string text = url();
    port = std::stoi(text.substr(text.find(':', 6) + 1));
    token = text.substr(text.find("token=") + 6);
  }
  ~Served() {
    if (child_ > 0) ::kill(child_, SIGKILL);
    wait();
  }
  /// Waits for its end; the exit code, 128 + signal when it was killed.
  int wait() {
    if (child_ <= 0) return code_;
    int status = 0;
    ::waitpid(child_, &status, 0);
    child_ = -1;
    return code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  void interrupt() const { ::kill(child_, SIGINT); }
  std::string out() const { return read_text(folder_ / "out"); }
  std::string err() const { return read_text(folder_ / "err"); }
  std::string host() const { return "127.0.0.1:" + std::to_string(port); }

  int port = 0;
  std::string token;

 private:
  std::string url() const {
    const std::string text = read_text(folder_ / "err") + read_text(folder_ / "out");
    const std::size_t at = text.find("http://"), end = text.find(' ', at);
    return at == text.npos || end == text.npos ? "" : text.substr(at, end - at);
  }
  TempFolder folder_;
  pid_t child_ = -1;
  int code_ = -1;
};

/// A connection to the loopback.
class Connection {
 public:
  explicit Connection(int port, int receive_buffer = 0, int patience_ms = 20'000)
      : fd_(::socket(AF_INET, SOCK_STREAM, 0)) {
    if (receive_buffer > 0) ::setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    const timeval patience = {patience_ms / 1000, 1000 * (patience_ms % 1000)};
    ::setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    ::setsockopt(fd_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    open_ = ::connect(fd_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
  }
  ~Connection() { ::close(fd_); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  bool open() const { return open_; }
  /// False when the other side has closed.
  bool send(const std::string& bytes) const {
    std::size_t sent = 0;
    while (sent < bytes.size()) {
      const ssize_t n = ::send(fd_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (n <= 0) return false;
      sent += static_cast<std::size_t>(n);
    }
    return true;
  }
  /// What comes next; empty at the end, or when its patience is.
  std::string receive(std::size_t most = 65536) const {
    std::string bytes(most, '\0');
    const ssize_t n = ::recv(fd_, bytes.data(), most, 0);
    bytes.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
    return bytes;
  }

 private:
  int fd_;
  bool open_ = false;
};

struct Request {
  std::string method = "GET", path = "/", token, host, origin, body, extra;
};

inline std::string text_of(const Request& r) {
  std::string text = r.method + " " + r.path + " HTTP/1.1\r\nHost: " + r.host + "\r\n" + r.extra;
  if (!r.token.empty()) text += "X-Tegotae-Token: " + r.token + "\r\n";
  if (!r.origin.empty()) text += "Origin: " + r.origin + "\r\n";
  if (r.method == "POST") text += "Content-Length: " + std::to_string(r.body.size()) + "\r\n";
  return text + "\r\n" + r.body;
}

/// Bytes that an answer has when it is whole; more than any while its head is not.
inline std::size_t length_of(const std::string& answer) {
  const std::size_t body = answer.find("\r\n\r\n"), length = answer.find("Content-Length: ");
  return body == answer.npos || length > body ? answer.max_size() : body + 4 + std::stoul(answer.substr(length + 16));
}

/// The answer's status; 0 when there was none.
inline int ask(int port, const Request& request, std::string* answer = nullptr) {
  const Connection connection(port);
  if (!connection.open() || !connection.send(text_of(request))) return 0;
  std::string text = connection.receive();
  for (std::string more = text; answer && !more.empty() && text.size() < length_of(text); text += more)
    more = connection.receive();
  if (answer) *answer = text;
  return text.rfind("HTTP/1.1 ", 0) == 0 ? std::stoi(text.substr(9, 3)) : 0;
}

}  // namespace tegotae::test
