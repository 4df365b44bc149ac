// On a terminal a viewed run opens the browser and waits for its page. A script in the place of xdg-open says what it
// was given.
#include <poll.h>
#include <pty.h>
#include <sys/stat.h>

#include <cstdlib>
#include <fstream>

#include "catch.hpp"
#include "view/http_client.hpp"

using namespace tegotae::test;
using Catch::Contains;

namespace {

/// peg_in_hole on a terminal of its own, with a desktop that has `folder`/xdg-open.
class OnTerminal {
 public:
  OnTerminal(const TempFolder& folder, std::vector<std::string> more) {
    std::vector<std::string> arguments = {TEGOTAE_BIN_DIR "/peg_in_hole", "--view"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const std::string path = (folder / "") + ":" + std::getenv("PATH");
    child_ = ::forkpty(&terminal_, nullptr, nullptr, nullptr);
    if (child_ == 0) {
      ::setenv("PATH", path.c_str(), 1);
      ::setenv("DISPLAY", ":7", 1);
      std::vector<char*> argv;
      for (std::string& a : arguments) argv.push_back(a.data());
      argv.push_back(nullptr);
      ::execv(argv[0], argv.data());
      ::_exit(127);
    }
    if (child_ < 0) throw std::runtime_error("no terminal");
  }
  ~OnTerminal() {
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
    ::close(terminal_);
  }
  OnTerminal(const OnTerminal&) = delete;
  OnTerminal& operator=(const OnTerminal&) = delete;

  /// Reads until `text` is on the terminal; false when it is not within `ms`.
  bool shows(const std::string& text, int ms = 30'000) {
    for (; out_.find(text) == out_.npos; ms -= 50) {
      pollfd ready{terminal_, POLLIN, 0};
      if (ms <= 0) return false;
      if (::poll(&ready, 1, 50) <= 0) continue;
      char buffer[4096];
      const ssize_t n = ::read(terminal_, buffer, sizeof buffer);
      if (n <= 0) return false;
      out_.append(buffer, static_cast<std::size_t>(n));
    }
    return true;
  }
  const std::string& out() const { return out_; }
  std::string url() const {
    const std::size_t at = out_.find("http://");
    return out_.substr(at, out_.find(' ', at) - at);
  }

 private:
  pid_t child_ = -1;
  int terminal_ = -1;
  std::string out_;
};

struct Place {
  explicit Place(const std::string& url)
      : port(std::stoi(url.substr(url.find(':', 6) + 1))), token(url.substr(url.find("token=") + 6)) {}
  int port;
  std::string token;
  Request page() const { return {"GET", "/?token=" + token, "", host(), "", "", ""}; }
  Request stream() const { return {"GET", "/stream", token, host(), "", "", ""}; }
  std::string host() const { return "127.0.0.1:" + std::to_string(port); }
};

/// A desktop whose xdg-open writes its argument to `folder`/opened.
void write_opener(const TempFolder& folder) {
  const std::string file = folder / "xdg-open";
  std::ofstream(file) << "#!/bin/sh\necho \"$1\" > '" << folder / "opening"
                      << "'\nmv '" << folder / "opening"
                      << "' '" << folder / "opened"
                      << "'\n";
  REQUIRE(::chmod(file.c_str(), 0700) == 0);
}

std::string opened(const TempFolder& folder) {
  for (int i = 0; i < 600 && ::access((folder / "opened").c_str(), R_OK) != 0; ++i) ::usleep(50'000);
  std::string url;
  std::getline(std::ifstream(folder / "opened") >> std::ws, url);
  return url;
}

}  // namespace

TEST_CASE("on a terminal the browser is opened, once, and the run waits for its page") {
  const TempFolder folder;
  write_opener(folder);
  OnTerminal run(folder, {});
  REQUIRE(run.shows("The run starts when the page is connected"));
  CHECK_THAT(run.out(), Contains("Your browser opens it"));
  const Place printed(run.url()), given(opened(folder));
  CHECK(given.port == printed.port);
  CHECK(given.token != printed.token);
  CHECK_FALSE(run.shows("; the run starts", 1000));

  // What the browser was given leads to the page once, and is good for nothing else.
  CHECK(ask(given.port, given.stream()) == 403);
  std::string answer;
  CHECK(ask(given.port, given.page(), &answer) == 303);
  CHECK_THAT(answer, Contains("Location: /?token=" + printed.token + "\r\n"));
  CHECK(ask(given.port, given.page()) == 403);
  CHECK(ask(printed.port, printed.page()) == 200);
  CHECK_FALSE(run.shows("; the run starts", 100));

  const Connection watcher(printed.port);
  REQUIRE(watcher.send(text_of(printed.stream())));
  CHECK(run.shows("The page is connected; the run starts"));
}

TEST_CASE("it is not opened where that is not wanted") {
  const TempFolder folder;
  write_opener(folder);
  OnTerminal run(folder, {"--no-browser"});
  REQUIRE(run.shows("The run starts when the page is connected"));
  const Place printed(run.url());
  const Connection watcher(printed.port);
  REQUIRE(watcher.send(text_of(printed.stream())));
  CHECK(run.shows("The page is connected; the run starts"));
  CHECK_THAT(run.out(), !Contains("Your browser"));
  CHECK(::access((folder / "opened").c_str(), F_OK) != 0);
}
