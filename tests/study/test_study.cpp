// Studies: which cases they have, what comes out of them where the answer is known, and what is refused.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <set>
#include <thread>

#include "catch.hpp"
#include "study/case_table.hpp"
#include "study/outcome.hpp"
#include "study/study.hpp"
#include "study/study_file.hpp"
#include "study_scene.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/import/load.hpp"

using namespace tegotae;
using namespace tegotae::test;
using namespace tegotae::study;
using Catch::Contains;

namespace {

/// The bound of Wilson's interval from its definition, without its closed form: the share p at which the observed one
/// is z standard deviations away, by bisection between the observed share and `end`.
double bound_by_bisection(double observed, double n, double end) {
  const double z = 1.959963984540054;
  double in = observed, out = end;
  for (int i = 0; i < 200; ++i) {
    const double p = 0.5 * (in + out);
    (std::abs(observed - p) <= z * std::sqrt(p * (1 - p) / n) ? in : out) = p;
  }
  return in;
}

Axis numbers(const std::string& name, std::vector<double> values) {
  Axis axis;
  axis.name = name;
  axis.numbers = std::move(values);
  return axis;
}

Axis drawn(const std::string& name, Axis::Draw draw, double low, double high) {
  Axis axis;
  axis.name = name;
  axis.draw = draw;
  axis.low = low;
  axis.high = high;
  return axis;
}

}  // namespace

TEST_CASE("the interval of a share is Wilson's") {
  for (const std::size_t n : {1u, 2u, 7u, 10u, 40u, 1000u})
    for (std::size_t k = 0; k <= n; k += std::max<std::size_t>(1, n / 10)) {
      INFO(k << " of " << n);
      const double observed = static_cast<double>(k) / static_cast<double>(n);
      const auto [low, high] = wilson_interval(k, n);
      CHECK(low == Approx(bound_by_bisection(observed, static_cast<double>(n), 0)).margin(1e-12));
      CHECK(high == Approx(bound_by_bisection(observed, static_cast<double>(n), 1)).margin(1e-12));
    }
  // Printed in textbooks: 0, 5 and 10 of 10.
  CHECK(wilson_interval(0, 10).second == Approx(0.2775).margin(5e-5));
  CHECK(wilson_interval(5, 10).first == Approx(0.2366).margin(5e-5));
  CHECK(wilson_interval(10, 10).first == Approx(0.7225).margin(5e-5));
}

TEST_CASE("a quantile lies between its neighbors") {
  CHECK(quantile({3}, 0.95) == 3);
  CHECK(quantile({1, 2}, 0.5) == 1.5);
  CHECK(quantile({1, 2, 4}, 0.5) == 2);
  CHECK(quantile({0, 10, 20, 30, 40}, 0.95) == Approx(38));
  CHECK(quantile({1, 2, 4}, 1) == 4);
}

TEST_CASE("what is to be looked at first is the best, the hardest, and of each part that blocked some one") {
  // Number, reached, time, force, who blocked it.
  const auto result = [](int number, bool reached, double time, double force, const std::string& part = "") {
    Result r;
    r.number = number;
    r.reached = reached;
    r.time = time;
    r.force = force;
    r.blocked_by = part;
    r.clearance = 1e-5;
    return r;
  };
  std::vector<Result> all = {result(0, true, 3, 1),         result(1, true, 2, 1),
                             result(2, false, 9, 4, "lid"), result(3, false, 9, 5, "lid"),
                             result(4, false, 9, 1, "lid"), result(5, false, 9, 1, "floor"),
                             result(6, false, 9, 1)};
  CHECK(worth_seeing(all, 3) == std::vector<int>{1, 3, 2});
  CHECK(worth_seeing(all, 100) == std::vector<int>{1, 3, 2, 5, 6, 4});
  CHECK(worth_seeing(all, 0).empty());
  CHECK(worth_seeing({}, 5).empty());
  // One that could not begin has nothing to be seen.
  all[3].clearance = 0;
  CHECK_FALSE(began(all[3]));
  CHECK(worth_seeing(all, 3) == std::vector<int>{1, 2, 5});
}

TEST_CASE("every combination comes as often as every other, and more repeats change no case") {
  Study study;
  study.axes = {numbers("mu", {0, 0.1, 0.2}), numbers("offset", {1e-3, 2e-3}),
                drawn("tilt", Axis::Draw::uniform, 0, 0.1)};
  study.repeats = 4;
  REQUIRE(case_count(study) == 24);
  std::map<std::pair<double, double>, std::set<int>> seen;
  std::set<double> tilts;
  for (int i = 0; i < 24; ++i) {
    const Case c = make_case(study, i);
    seen[{c.find("mu")->number, c.find("offset")->number}].insert(c.repeat);
    tilts.insert(c.find("tilt")->number);
  }
  CHECK(seen.size() == 6);
  for (const auto& [values, repeats] : seen) CHECK(repeats == std::set<int>{0, 1, 2, 3});
  CHECK(tilts.size() == 24);
  Study longer = study;
  longer.repeats = 9;
  for (int i = 0; i < 24; ++i)
    CHECK(parameter_cells(longer, make_case(longer, i)) == parameter_cells(study, make_case(study, i)));
  Study other = study;
  other.seed = 2;
  CHECK(make_case(other, 5).find("tilt")->number != make_case(study, 5).find("tilt")->number);
}

TEST_CASE("draws keep their bounds and have the moments of their distributions") {
  constexpr int kDraws = 20000;
  for (const Axis::Draw draw : {Axis::Draw::uniform, Axis::Draw::tolerance}) {
    Study study;
    study.axes = {drawn("mu", draw, 1, 4)};
    study.repeats = kDraws;
    double sum = 0, squares = 0;
    for (int i = 0; i < kDraws; ++i) {
      const double x = make_case(study, i).find("mu")->number;
      REQUIRE(x >= 1);
      REQUIRE(x <= 4);
      sum += x;
      squares += (x - 2.5) * (x - 2.5);
    }
    // Uniform: width² / 12. Normal cut at three deviations: 0.9733 of (width / 6)².
    const double variance = draw == Axis::Draw::uniform ? 9.0 / 12 : 0.9733 * 9.0 / 36;
    CHECK(sum / kDraws == Approx(2.5).margin(4 * std::sqrt(variance / kDraws)));
    CHECK(squares / kDraws == Approx(variance).epsilon(0.04));
  }
}

TEST_CASE("a case that is stopped at any moment is the whole case, or none") {
  const TempFolder folder;
  write_blocks(folder);
  Study study;
  study.scenes = {folder / "scene.toml"};
  study.hold = "block";
  study.goal = "0,0,0.01002";
  study.seconds = 6;
  const auto tasks =
      load_tasks(study, [](const std::string& path, double unit_in_m) { return load_mesh(path, unit_in_m); });
  const Case c = make_case(study, 0);
  const auto begin = std::chrono::steady_clock::now();
  const std::string whole = row_text(run_case(study, *tasks, c, std::atomic<bool>{false}).value());
  const auto took = std::chrono::steady_clock::now() - begin;
  int stopped = 0;
  for (int i = 0; i < 60; ++i) {
    std::atomic<bool> stop{false};
    std::thread stopper([&] {
      std::this_thread::sleep_for(took * i / 50);
      stop = true;
    });
    const auto result = run_case(study, *tasks, c, stop);
    stopper.join();
    if (result) CHECK(row_text(*result) == whole);
    stopped += !result;
  }
  CHECK(stopped > 10);
}

TEST_CASE("what is wrong in a study file is told with line and key") {
  const TempFolder folder;
  write_blocks(folder);
  const auto refused = [&](const std::string& text, const std::string& why) {
    folder.write("study.toml", text);
    INFO(text);
    CHECK_THROWS_WITH(read_study(folder / "study.toml"), Contains(folder / "study.toml:") && Contains(why));
  };
  const std::string good = "scenes = [\"scene.toml\"]\n";
  folder.write("study.toml", good);
  CHECK(case_count(read_study(folder / "study.toml")) == 1);
  refused("", "scenes: must be a list");
  refused("scenes = [\"no.toml\"]\n", ":1: scenes: ");
  refused(good + "repeat = 3\n", ":2: repeat: unknown key");
  refused(good + "repeats = 2.5\n", ":2: repeats: must be a whole number");
  refused(good + "goal = \"up\"\n", ":2: goal: up is not a pose");
  refused(good + "[parameters]\ntilt_deg = [90]\n", ":3: parameters.tilt_deg: 90 is not from 0 to 45");
  refused(good + "[parameters]\nmu = { uniform = [2, 1] }\n", "mu.uniform: the first number must be less");
  refused(good + "[parameters]\nmu = { normal = [0, 1] }\n", "mu.normal: unknown key");
  refused(good + "[parameters]\nmu = {}\n", ":3: parameters.mu: give either");
  refused(good + "[parameters]\noperator = [\"clumsy\"]\n", ":3: parameters.operator: ");
  refused(good + "[parameters]\noperator = [\"hasty\", \"hasty\"]\n", "is in it twice");
  refused(good + "[parameters]\nmu = [0.1, 0.2, 0.10]\n", ":3: parameters.mu: 0.1 is in it twice");
  const std::string order = "[[parameters.order]]\nparts = [\"block\", \"floor\"]\n";
  refused(good + "goal = \"out\"\n" + order + order, ":6: parameters.order.parts: another order has the same");
  refused(good + "[[parameters.inward]]\npart = \"block\"\n", "parameters.inward.by: missing");
  refused(good + "[[parameters.order]]\nparts = [\"block\"]\n", "goal: must be \"out\" where there are orders");
  refused(good + "repeats = 1000000\n[parameters]\nmu = [0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]\n",
          "more than ten million");
  // 2 to the power of 64 cases: as many as none to who counts in whole numbers of this machine.
  std::string many = good, values;
  for (int i = 1; i <= 256; ++i) values += (i == 1 ? "" : ", ") + std::to_string(i) + "e-6";
  for (int i = 0; i < 8; ++i)
    many += "[[parameters.inward]]\npart = \"p" + std::to_string(i) + "\"\nby = [" + values + "]\n";
  refused(many, "more than ten million");
}
