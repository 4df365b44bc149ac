// Requests and a watching page, for programs that serve one.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "view/http_client.hpp"

namespace tegotae::test {

inline Request get(const Served& s, const std::string& path) {
  return {"GET", path, s.token, s.host(), "", "", ""};
}
inline Request command(const Served& s, const std::string& body) {
  return {"POST", "/command", s.token, s.host(), "http://" + s.host(), body, ""};
}

/// A page that watches.
class Watcher {
 public:
  /// Waits for a place: pages that have gone are noticed with the next frame.
  explicit Watcher(const Served& s) {
    for (int i = 0; i < 100; ++i) {
      connection_ = std::make_unique<Connection>(s.port);
      connection_->send(text_of(get(s, "/stream")));
      buffer_ = connection_->receive();
      const std::size_t body = buffer_.find("\r\n\r\n");
      if (buffer_.rfind("HTTP/1.1 200", 0) == 0 && body != buffer_.npos) {
        buffer_.erase(0, body + 4);
        return;
      }
      ::usleep(100'000);
    }
    throw std::runtime_error("no place to watch: " + buffer_);
  }
  /// The tick of the next frame; -1 at the end.
  long next() { return next_row() ? static_cast<long>(row_[0]) * (1 << 20) + static_cast<long>(row_[1]) : -1; }
  /// The numbers of the newest frame (apps/view/wire.cpp), without its pairs.
  const std::vector<float>& row() const { return row_; }

  /// The newest status that came along with the frames so far; empty before the first.
  const std::string& status() const { return status_; }

 private:
  static constexpr std::size_t kFloats = 34;

  bool next_row() {
    for (;;) {
      while (buffer_.size() >= 8) {
        std::uint32_t head[2];
        std::memcpy(head, buffer_.data(), 8);
        if (head[0] != 1 && head[0] != 2) throw std::runtime_error("no message");
        if (buffer_.size() < 8 + head[1]) break;
        if (head[0] == 1) std::memcpy(row_.data(), buffer_.data() + 8, kFloats * sizeof(float));
        if (head[0] == 2) status_ = buffer_.substr(8, head[1]);
        buffer_.erase(0, 8 + head[1]);
        if (head[0] == 1) return true;
      }
      const std::string more = connection_->receive();
      if (more.empty()) return false;
      buffer_ += more;
    }
  }

  std::unique_ptr<Connection> connection_;
  std::string buffer_, status_;
  std::vector<float> row_ = std::vector<float>(kFloats);
};

/// The run is alive: frames come, and their ticks go up.
inline void check_going_on(const Served& s) {
  Watcher watcher(s);
  const long first = watcher.next();
  CHECK(first >= 0);
  long last = first;
  for (int i = 0; i < 10; ++i) {
    const long tick = watcher.next();
    CHECK(tick > last);
    last = tick;
  }
}

inline void check_end(Served& s) {
  s.interrupt();
  CHECK(s.wait() == 0);
  const auto summary = nlohmann::json::parse(s.out());
  CHECK(summary.at("penetrating") == 0);
  CHECK(summary.at("ticks").get<double>() > 0);
}

}  // namespace tegotae::test
