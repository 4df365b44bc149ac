// `tegotae review --forces --mu` as a user runs it, on a peg that goes straight down into its hole without friction.
#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <vector>

#include "apps/run_program.hpp"
#include "catch.hpp"
#include "tegotae/record/recording.hpp"

using namespace tegotae;
using namespace tegotae::test;
using Catch::Contains;

namespace {

const char* const kHeader =
    "depth_mm,insertion_n,insertion_peak_n,friction_n,seating_n,pull_out_n,pull_out_peak_n,low_n,high_n";

/// The cells of a table by its columns.
std::map<std::string, std::vector<std::string>> columns_of(const std::string& text) {
  std::istringstream in(text), names(kHeader);
  std::string line, name, cell;
  REQUIRE(std::getline(in, line));
  REQUIRE(line == kHeader);
  std::vector<std::string> order;
  while (std::getline(names, name, ',')) order.push_back(name);
  std::map<std::string, std::vector<std::string>> out;
  while (std::getline(in, line)) {
    std::istringstream cells(line + ",");
    for (const std::string& column : order) {
      REQUIRE(std::getline(cells, cell, ','));
      out[column].push_back(cell);
    }
  }
  return out;
}

/// The numbers of a column; empty cells are left out.
std::vector<double> numbers(const std::vector<std::string>& cells) {
  std::vector<double> out;
  for (const std::string& cell : cells)
    if (!cell.empty()) out.push_back(std::stod(cell));
  return out;
}

double sum(const std::vector<double>& v) {
  double out = 0;
  for (const double x : v) out += x;
  return out;
}

/// What a recording says of a motion along a direction.
struct Along {
  double way = 0, peak = 0;  ///< m; N, against the part while it goes on
  Along(const Recording& r, const Vec3& direction) {
    const double start = direction.dot(r.frames.front().x.p);
    double before = start;
    for (std::size_t i = 0; i < r.frames.size(); ++i) {
      const RecordFrame& f = r.frames[i];
      if (i + 1 < r.frames.size() && r.frames[i + 1].tick == f.tick) continue;
      double against = 0;
      for (int k = 0; k < f.forces.count; ++k) {
        const ContactForce& c = f.forces.items[static_cast<std::size_t>(k)];
        against -= direction.dot(c.force * c.n + c.friction);
      }
      const double gone = direction.dot(f.x.p);
      if (gone - before > 1e-7) peak = std::max(peak, against);
      before = gone;
      way = std::max(way, gone - start);
    }
  }
};

}  // namespace

TEST_CASE("the force of a peg over its depth is the recorded contacts', and friction makes it more") {
  const TempFolder folder;
  REQUIRE(run_program("peg_in_hole", "--ratio 0.94 --fast --scene-out " + folder / "m").code == 0);
  const std::string scene = folder / "m/peg_in_hole_0.94.toml", recording = folder / "r.mcap";
  REQUIRE(run_program("tegotae", "run --fast --record " + recording + " " + scene).code == 0);
  const std::string table = folder / "forces.csv";
  // The scene has no friction: led once more with a coefficient of 0 the part does what it did.
  const Output o = run_program("tegotae", "review " + recording + " --forces " + table + " --mu 0:0.3");
  INFO(o.out << o.err);
  REQUIRE(o.code == 0);
  CHECK_THAT(o.out, Contains("insertion: at most ") && Contains("insertion with friction of 0 to 0.3: "));

  auto columns = columns_of(read_text(table));
  const Along down(read_recording(recording), -Vec3::UnitZ());
  const std::vector<double> depth = numbers(columns["depth_mm"]);
  REQUIRE(depth.size() == 200);
  const double segment = depth[1] - depth[0];
  CHECK(depth[0] == Approx(segment / 2).epsilon(1e-3));
  CHECK(std::is_sorted(depth.begin(), depth.end()));
  // The peg may tilt, so that its file frame and its center go a little differently far.
  CHECK(depth.back() + segment / 2 == Approx(1e3 * down.way).margin(0.1));
  const std::vector<double> peaks = numbers(columns["insertion_peak_n"]);
  REQUIRE(peaks.size() > 100);
  REQUIRE(down.peak > 0.1);
  CHECK(*std::max_element(peaks.begin(), peaks.end()) == Approx(down.peak).epsilon(0.01));
  for (std::size_t i = 0; i < 200; ++i) {
    const std::string &mean = columns["insertion_n"][i], &most = columns["insertion_peak_n"][i];
    REQUIRE(mean.empty() == most.empty());
    if (!mean.empty()) CHECK(std::stod(mean) <= std::stod(most) + 1e-9);
  }
  for (const double f : numbers(columns["friction_n"])) CHECK(f == 0);
  // Where it went up a little it was free.
  for (const double f : numbers(columns["pull_out_peak_n"])) CHECK(f <= 0);
  CHECK(columns["low_n"] == columns["insertion_n"]);
  const std::vector<double> low = numbers(columns["low_n"]), high = numbers(columns["high_n"]);
  CHECK(sum(high) / static_cast<double>(high.size()) > 2 * sum(low) / static_cast<double>(low.size()));
  for (const auto& [name, cells] : columns)
    for (const std::string& cell : cells) REQUIRE(cell != "-0");
}

TEST_CASE("what it takes to pull a peg out is the recorded contacts' force, as the pull-out") {
  const TempFolder folder;
  REQUIRE(run_program("tegotae-models", "--puzzles --out " + (folder / "p")).code == 0);
  folder.write("p/rubs.toml", read_text(folder / "p/straight.toml") + "\n[friction]\nmu = 0.3\n");
  // Pressed against a wall of its hole, and up.
  folder.write("script.csv",
               "t,px,py,pz,qw,qx,qy,qz\n0,0,0,-0.0049,1,0,0,0\n0.3,0.003,0,-0.0049,1,0,0,0\n2,0.003,0,0.02,1,0,0,0\n");
  const std::string recording = folder / "r.mcap", table = folder / "f.csv";
  REQUIRE(run_program("tegotae", "run --fast " + (folder / "p/rubs.toml") + " --script " + (folder / "script.csv") +
                                     " --record " + recording)
              .code == 0);
  const Output o = run_program("tegotae", "review " + recording + " --forces " + table + " --mu 0:0.6");
  INFO(o.out << o.err);
  REQUIRE(o.code == 0);
  CHECK_THAT(o.out, Contains("It comes out\n") && Contains("pull-out: at most ") && Contains("% of it friction") &&
                        Contains("pull-out with friction of 0 to 0.6: ") && !Contains("insertion with"));
  // Against the way from start to goal, while the part goes on along it.
  const Along out(read_recording(recording), Vec3(0.003, 0, 0.0249).normalized());
  REQUIRE(out.peak > 0.1);
  auto columns = columns_of(read_text(table));
  const std::vector<double> peaks = numbers(columns["pull_out_peak_n"]);
  REQUIRE(peaks.size() > 100);
  // Its center goes a little differently from its file frame where it tilts.
  CHECK(*std::max_element(peaks.begin(), peaks.end()) == Approx(out.peak).epsilon(0.03));
  const std::vector<double> low = numbers(columns["low_n"]), high = numbers(columns["high_n"]);
  CHECK(sum(high) / static_cast<double>(high.size()) > sum(low) / static_cast<double>(low.size()) + 0.05);
}

TEST_CASE("forces that a recording does not have, and bands that are none, are one line") {
  const TempFolder folder;
  write_small_scene(folder);
  const std::string recording = folder / "r.csv";
  REQUIRE(run_program("tegotae", "run --fast --record " + recording + " " + folder / "scene.toml").code == 0);
  const auto refused = [&](const std::string& options, const std::string& why) {
    const Output o = run_program("tegotae", "review " + recording + " " + options);
    INFO(options << "\n" << o.out << o.err);
    CHECK(o.code == 2);
    CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
    CHECK_THAT(o.err, Contains(why));
  };
  refused("--forces " + folder / "f.csv", "has no contact forces");
  CHECK_FALSE(std::filesystem::exists(folder / "f.csv"));
  for (const char* band : {"0.3:0.1", "0.3", "-0.1:0.3", "0:11", "0:0.3x"})
    refused("--mu " + std::string(band), "is not LOW:HIGH");
}
