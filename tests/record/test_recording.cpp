// Reading recordings back: the writer's own frames, files that other programs changed, and files that broke.
#include <fstream>
#include <iterator>
#include <limits>

#include "catch.hpp"
#include "record/frame_messages.hpp"
#include "record/mcap_format.hpp"
#include "record/random_frames.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/record/recorder.hpp"

using namespace tegotae;
using test::random_frame;
using test::TemporaryFile;

namespace {

const char* const kHeader =
    "tick,substep,t,y_px,y_py,y_pz,y_qw,y_qx,y_qy,y_qz,x_px,x_py,x_pz,x_qw,x_qx,x_qy,x_qz,fx,fy,fz,tx,ty,tz,contacts,"
    "gap,tick_us";
const char* const kRow = "7,1,0.5,1,2,3,1,0,0,0,4,5,6,0,1,0,0,7,8,9,10,11,12,3,inf,21.5";

bool same(const RecordFrame& a, const RecordFrame& b) {
  return a.tick == b.tick && a.substep == b.substep && a.t == b.t && a.y.p == b.y.p &&
         a.y.q.coeffs() == b.y.q.coeffs() && a.x.p == b.x.p && a.x.q.coeffs() == b.x.q.coeffs() &&
         a.wrench.force == b.wrench.force && a.wrench.torque == b.wrench.torque && a.contacts == b.contacts &&
         a.gap == b.gap && a.tick_us == b.tick_us && a.lag_reason == b.lag_reason;
}

std::string contents(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return std::string((std::istreambuf_iterator<char>(in)), {});
}

void write(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::vector<RecordFrame> record(const std::string& path, int frames, const RecordingInfo& info = {}) {
  std::mt19937_64 rng(11);
  std::vector<RecordFrame> out;
  for (int i = 0; i < frames; ++i) out.push_back(random_frame(rng));
  out.front().gap = std::numeric_limits<double>::infinity();
  Recorder recorder(path, RecordMode::synchronous, info);
  for (const RecordFrame& f : out) recorder.push(f);
  recorder.close();
  return out;
}

/// As versions wrote it that knew no contact forces; without chunks.
std::string without_forces(const std::vector<RecordFrame>& frames) {
  mcap::Bytes file;
  file.text = mcap::kMagic;
  const auto id = [](std::size_t topic) { return static_cast<std::uint16_t>(topic + 1); };
  for (std::size_t i = 0; i < kFrameTopics; ++i)
    if (i != kForcesTopic)
      file.record(mcap::kChannel, mcap::Bytes()
                                      .put(id(i))
                                      .put(std::uint16_t{0})
                                      .put(std::string_view(kTopics[i].topic))
                                      .put(std::string_view("json")));
  for (const RecordFrame& frame : frames) {
    for (std::size_t i = 0; i < kFrameTopics; ++i) {
      mcap::Bytes message = mcap::Bytes().put(id(i)).put(std::uint32_t{0}).put(std::uint64_t{0}).put(std::uint64_t{0});
      message.text += message_text(frame, i);
      if (i != kForcesTopic) file.record(mcap::kMessage, message);
    }
  }
  return file.record(mcap::kDataEnd, mcap::Bytes().put(std::uint32_t{0})).text;
}

}  // namespace

TEST_CASE("a recording comes back bit by bit, with its info", "[recording]") {
  const std::string ending = GENERATE(".csv", ".mcap");
  const TemporaryFile file(ending);
  const RecordingInfo info = {"scenes/\"peg\".toml", "peg µ", "qp", "test 1"};
  const std::vector<RecordFrame> frames = record(file.path, 1500, info);
  const Recording read = read_recording(file.path);
  CHECK(read.damage.empty());
  CHECK(read.info.scene == info.scene);
  CHECK(read.info.held == info.held);
  CHECK(read.info.resolver == info.resolver);
  CHECK(read.info.program == info.program);
  REQUIRE(read.frames.size() == frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) REQUIRE(same(read.frames[i], frames[i]));
}

TEST_CASE("contact forces come back from MCAP, and a recording of a version without them is read", "[recording]") {
  const TemporaryFile file(".mcap");
  std::mt19937_64 rng(12);
  std::vector<RecordFrame> frames;
  for (int i = 0; i < 300; ++i) {
    frames.push_back(random_frame(rng));
    frames.back().forces = test::random_forces(rng);
  }
  Recorder recorder(file.path, RecordMode::synchronous);
  for (const RecordFrame& f : frames) recorder.push(f);
  recorder.close();
  const Recording read = read_recording(file.path);
  REQUIRE(read.frames.size() == frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const ContactForces &a = frames[i].forces, &b = read.frames[i].forces;
    REQUIRE(same(read.frames[i], frames[i]));
    REQUIRE(a.count == b.count);
    for (std::size_t k = 0; k < static_cast<std::size_t>(a.count); ++k) {
      REQUIRE(a.items[k].part == b.items[k].part);
      REQUIRE(a.items[k].point == b.items[k].point);
      REQUIRE(a.items[k].n == b.items[k].n);
      REQUIRE(a.items[k].gap == b.items[k].gap);
      REQUIRE(a.items[k].force == b.items[k].force);
      REQUIRE(a.items[k].mu == b.items[k].mu);
      REQUIRE(a.items[k].friction == b.items[k].friction);
      REQUIRE(a.items[k].slides == b.items[k].slides);
    }
    REQUIRE(a.lag.force == b.lag.force);
    REQUIRE(a.lag.torque == b.lag.torque);
  }
  write(file.path, without_forces(frames));
  const Recording old = read_recording(file.path);
  CHECK(old.damage.empty());
  REQUIRE(old.frames.size() == frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    REQUIRE(same(old.frames[i], frames[i]));
    REQUIRE(old.frames[i].forces.count == 0);
  }
}

TEST_CASE("a recording without info takes no one else's", "[recording]") {
  const TemporaryFile file(".csv");
  record(file.path, 1, {"old.toml", "peg", "qp", "test"});
  record(file.path, 1);
  CHECK(read_recording(file.path).info.scene.empty());
}

TEST_CASE("columns are found by name; comments, other columns and Windows line ends are no matter", "[recording]") {
  const TemporaryFile file(".csv");
  write(file.path, std::string("# a comment\r\nextra,") + kHeader + "\r\n\r\nnote," + kRow + "\r\n");
  const Recording read = read_recording(file.path);
  REQUIRE(read.frames.size() == 1);
  const RecordFrame& f = read.frames[0];
  CHECK(f.tick == 7);
  CHECK(f.substep == 1);
  CHECK(f.t == 0.5);
  CHECK(f.y.p == Vec3(1, 2, 3));
  CHECK(f.y.q.w() == 1);
  CHECK(f.x.p == Vec3(4, 5, 6));
  CHECK(f.x.q.x() == 1);
  CHECK(f.wrench.force == Vec3(7, 8, 9));
  CHECK(f.wrench.torque == Vec3(10, 11, 12));
  CHECK(f.contacts == 3);
  CHECK(f.gap == std::numeric_limits<double>::infinity());
  CHECK(f.tick_us == 21.5);
}

TEST_CASE("why the part lagged is a number of its own, and recordings of before are read without it", "[recording]") {
  const TemporaryFile file(".csv");
  const auto with = [](const std::string& reason) {
    return std::string(kHeader) + ",lag_reason\n" + kRow + "," + reason + "\n";
  };
  write(file.path, with("3"));
  CHECK(read_recording(file.path).frames.at(0).lag_reason == LagReason::capacity);
  write(file.path, std::string(kHeader) + "\n" + kRow + "\n");
  CHECK(read_recording(file.path).frames.at(0).lag_reason == LagReason::none);
  for (const char* reason : {"5", "-1"}) {
    write(file.path, with(reason));
    CHECK_THROWS_WITH(read_recording(file.path), Catch::Contains(std::string(":2: lag_reason: ") + reason + " is no"));
  }
}

TEST_CASE("what is wrong with a CSV recording is told with its line and column", "[recording]") {
  const TemporaryFile file(".csv");
  const auto message = [&](const std::string& text) -> std::string {
    write(file.path, text);
    try {
      read_recording(file.path);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  const std::string head = std::string(kHeader) + "\n", row = std::string(kRow) + "\n";
  CHECK(message("") == file.path + ":0: no header row");
  CHECK(message("tick,substep\n") == file.path + ":1: t: this column is missing; is this a recording?");
  CHECK(message(head + row + "1,2\n") == file.path + ":3: the row has 2 cells instead of 26");
  CHECK(message(head + "7,1,0.5,x" + row.substr(row.find(",1,2,3") + 2)) ==
        file.path + ":2: y_px: \"x\" is not a number");
  CHECK(message(head + "-7" + row.substr(1)) == file.path + ":2: tick: \"-7\" is not a number");
  CHECK_THROWS_WITH(read_recording("/nonexistent/r.csv"), Catch::Contains("/nonexistent/r.csv: cannot read"));
  CHECK_THROWS_WITH(read_recording("/tmp"), Catch::Contains("/tmp: cannot read"));
}

TEST_CASE("a recording that was cut is read up to there", "[recording]") {
  const std::string ending = GENERATE(".csv", ".mcap");
  const TemporaryFile file(ending);
  // Enough for several chunks.
  const std::vector<RecordFrame> frames = record(file.path, 1500);
  const std::string whole = contents(file.path);
  std::mt19937_64 rng(2);
  for (int i = 0; i < 60; ++i) {
    // Behind the header row of a CSV file; an MCAP file has its end (summary) in the last few kilobytes.
    const std::size_t length = 1000 + rng() % (whole.size() - 10'000);
    write(file.path, whole.substr(0, length));
    const Recording read = read_recording(file.path);
    const bool at_row_end = ending == ".csv" && whole[length - 1] == '\n';
    REQUIRE(read.damage.empty() == at_row_end);
    for (std::size_t k = 0; k < read.frames.size(); ++k) REQUIRE(same(read.frames[k], frames[k]));
    // Every row or chunk before the cut is there: random frames all take about as much room.
    const double expected = static_cast<double>(frames.size() * length) / static_cast<double>(whole.size());
    const double lost = ending == ".csv" ? 30 : 400;
    INFO(read.frames.size() << " frames of " << expected);
    REQUIRE(std::abs(static_cast<double>(read.frames.size()) - expected) < lost);
  }
}

TEST_CASE("a broken recording is refused or read in part, and nothing else", "[recording]") {
  const std::string ending = GENERATE(".csv", ".mcap");
  const TemporaryFile file(ending);
  record(file.path, 40);
  const std::string whole = contents(file.path);
  std::mt19937_64 rng(23);
  int refused = 0, read = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string broken = whole;
    for (std::size_t k = 0; k <= rng() % 4; ++k) broken[rng() % broken.size()] = static_cast<char>(rng());
    if (i % 7 == 0) broken.resize(rng() % broken.size());
    write(file.path, broken);
    std::size_t frames = 0;
    std::string error;
    try {
      frames = read_recording(file.path).frames.size();
      ++read;
    } catch (const Error& e) {
      error = e.what();
      ++refused;
    }
    REQUIRE(frames <= 41);  // a comma may become an end of line
    if (!error.empty()) REQUIRE(error.find(file.path + ":") == 0);
  }
  INFO(refused << " refused, " << read << " read");
  CHECK(read > 0);
  CHECK(refused > 0);
}
