#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <clocale>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <thread>

#include "catch.hpp"
#include "child_process.hpp"
#include "record/random_frames.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/record/recorder.hpp"

using namespace tegotae;
using test::random_frame;
using test::TemporaryFile;

namespace {

std::vector<std::string> lines_of(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells(1);
  for (char c : line)
    if (c == ',')
      cells.emplace_back();
    else
      cells.back() += c;
  return cells;
}

std::vector<double> numbers_of(const RecordFrame& f) {
  std::vector<double> v = {f.t};
  for (const Pose* X : {&f.y, &f.x})
    for (double number : {X->p.x(), X->p.y(), X->p.z(), X->q.w(), X->q.x(), X->q.y(), X->q.z()}) v.push_back(number);
  for (const Vec3* u : {&f.wrench.force, &f.wrench.torque})
    for (int i = 0; i < 3; ++i) v.push_back((*u)[i]);
  return v;
}

const char* const kHeader =
    "tick,substep,t,y_px,y_py,y_pz,y_qw,y_qx,y_qy,y_qz,x_px,x_py,x_pz,x_qw,x_qx,x_qy,x_qz,fx,fy,fz,tx,ty,tz,contacts,"
    "gap,tick_us,lag_reason";

/// Limits the size of files that this process writes, and takes it back.
struct FileSizeLimit {
  rlimit before{};
  explicit FileSizeLimit(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit now{bytes, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &now);
  }
  ~FileSizeLimit() { setrlimit(RLIMIT_FSIZE, &before); }
};

}  // namespace

TEST_CASE("what is read from a recording are the same bits", "[record]") {
  const RecordMode mode = GENERATE(RecordMode::synchronous, RecordMode::threaded);
  // A locale with a decimal comma must not matter; where it is not installed this changes nothing.
  std::setlocale(LC_ALL, "de_DE.UTF-8");
  const TemporaryFile file;
  std::mt19937_64 rng(7);
  std::vector<RecordFrame> frames;
  for (int i = 0; i < 2000; ++i) frames.push_back(random_frame(rng));
  frames[1].gap = std::numeric_limits<double>::infinity();
  Recorder recorder(file.path, mode);
  for (const RecordFrame& f : frames) recorder.push(f);
  CHECK(recorder.rows() == frames.size());
  CHECK(recorder.dropped() == 0);
  recorder.close();
  std::setlocale(LC_ALL, "C");

  const std::vector<std::string> lines = lines_of(file.path);
  REQUIRE(lines.size() == frames.size() + 1);
  REQUIRE(lines[0] == kHeader);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::vector<std::string> cells = split(lines[i + 1]);
    REQUIRE(cells.size() == 27);
    REQUIRE(std::strtoull(cells[0].c_str(), nullptr, 10) == frames[i].tick);
    REQUIRE(std::strtoull(cells[1].c_str(), nullptr, 10) == frames[i].substep);
    const std::vector<double> expected = numbers_of(frames[i]);
    REQUIRE(expected.size() == 21);
    for (std::size_t k = 0; k < expected.size(); ++k) {
      char* end = nullptr;
      REQUIRE(std::strtod(cells[k + 2].c_str(), &end) == expected[k]);
      REQUIRE(*end == 0);
    }
    REQUIRE(std::atoi(cells[23].c_str()) == frames[i].contacts);
    REQUIRE(std::strtod(cells[24].c_str(), nullptr) == frames[i].gap);
    REQUIRE(std::strtod(cells[25].c_str(), nullptr) == frames[i].tick_us);
    REQUIRE(std::atoi(cells[26].c_str()) == static_cast<int>(frames[i].lag_reason));
  }
  CHECK(split(lines[2])[24] == "inf");
}

TEST_CASE("a recording that cannot be made says so at once", "[record]") {
  CHECK_THROWS_WITH(Recorder("/nonexistent/dir/r.csv", RecordMode::synchronous),
                    Catch::Contains("/nonexistent/dir/r.csv") && Catch::Contains("No such file"));
  CHECK_THROWS_WITH(Recorder("/dev/full", RecordMode::threaded),
                    Catch::Contains("/dev/full") && Catch::Contains("No space left"));
}

TEST_CASE("a disk that becomes full is told when closing", "[record]") {
  const RecordMode mode = GENERATE(RecordMode::synchronous, RecordMode::threaded);
  const TemporaryFile file;
  const FileSizeLimit limit(100'000);
  Recorder recorder(file.path, mode);
  std::mt19937_64 rng(3);
  for (int i = 0; i < 2000; ++i) recorder.push(random_frame(rng));
  CHECK_THROWS_WITH(recorder.close(), Catch::Contains(file.path) && Catch::Contains("File too large"));
  CHECK(std::filesystem::file_size(file.path) == 100'000);
  CHECK_NOTHROW(recorder.close());
}

TEST_CASE("a full ring drops frames and counts them", "[record]") {
  const TemporaryFile file;
  Recorder recorder(file.path, RecordMode::threaded, {}, 8);
  RecordFrame frame;
  // Far more and faster than the ring holds between two visits of the writer.
  for (int i = 0; i < 10'000; ++i) {
    frame.tick = static_cast<std::uint64_t>(i);
    recorder.push(frame);
  }
  recorder.close();
  CHECK(recorder.dropped() > 0);
  CHECK(recorder.rows() + recorder.dropped() == 10'000);
  const std::vector<std::string> lines = lines_of(file.path);
  REQUIRE(lines.size() == recorder.rows() + 1);
  long last = -1;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const long tick = std::atol(lines[i].c_str());
    REQUIRE(tick > last);
    last = tick;
  }
}

TEST_CASE("a killed process leaves whole rows, but for the last one", "[record]") {
  const RecordMode mode = GENERATE(RecordMode::synchronous, RecordMode::threaded);
  const TemporaryFile file;
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    Recorder recorder(file.path, mode);
    std::mt19937_64 rng(5);
    for (;;) {
      recorder.push(random_frame(rng));
      if (mode == RecordMode::threaded) std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
  }
  const auto enough = [&file] { return std::filesystem::file_size(file.path) > 200'000; };
  for (int i = 0; i < 6000 && !enough(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  REQUIRE(enough());
  std::ifstream in(file.path);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  // A kill can end a write at a page boundary of the file, in the middle of the last row.
  std::vector<std::string> lines = lines_of(file.path);
  if (text.back() != '\n') lines.pop_back();
  REQUIRE(lines.size() > 100);
  for (std::size_t i = 1; i < lines.size(); ++i) REQUIRE(split(lines[i]).size() == 27);
}

TEST_CASE("a limit of size or a reader that goes kills nobody, whatever the program does about signals", "[record]") {
  const bool mcap = GENERATE(false, true), threaded = GENERATE(false, true), pipe = GENERATE(false, true);
  const TemporaryFile file;
  const std::string path = file.path + (mcap ? ".mcap" : ".csv");
  test::ChildProcess child([&](const auto& say) {
    std::signal(SIGXFSZ, SIG_DFL);
    std::signal(SIGPIPE, SIG_DFL);
    int reader = -1;
    if (pipe) {
      if (mkfifo(path.c_str(), 0600) != 0) return;
      reader = open(path.c_str(), O_RDONLY | O_NONBLOCK);
    } else {
      const rlimit limit{50'000, 50'000};
      setrlimit(RLIMIT_FSIZE, &limit);
    }
    Recorder recorder(path, threaded ? RecordMode::threaded : RecordMode::synchronous);
    if (pipe) close(reader);
    std::mt19937_64 rng(3);
    for (int i = 0; i < 2000; ++i) recorder.push(random_frame(rng));
    try {
      recorder.close();
      say(0);
    } catch (const Error& e) {
      const std::string text = e.what();
      say(text.find(pipe ? "Broken pipe" : "File too large") != text.npos && text.find("of 2000 rows") != text.npos);
    }
    // The mask is as it was, and nothing waits to be delivered.
    sigset_t set;
    pthread_sigmask(SIG_SETMASK, nullptr, &set);
    const bool blocked = sigismember(&set, SIGPIPE) == 1 || sigismember(&set, SIGXFSZ) == 1;
    sigpending(&set);
    say(blocked || sigismember(&set, SIGPIPE) == 1 || sigismember(&set, SIGXFSZ) == 1);
  });
  CAPTURE(mcap, threaded, pipe);
  CHECK(child.hear() == 1);
  CHECK(child.hear() == 0);
  CHECK(child.wait() == 0);
  std::filesystem::remove(path);
}
