#include "apps/experiment_judges.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "apps/run_program.hpp"
#include "catch.hpp"

namespace tegotae::test {
namespace {

// Tables are written with six digits; lengths of the scenes stay under 50 mm.
constexpr double kDigits = 1e-4;  // mm

/// A row of a table by the names of its columns.
class Row {
 public:
  Row(const std::vector<std::string>& names, const std::string& line) {
    std::istringstream cells(line);
    std::string cell;
    for (const std::string& name : names)
      if (std::getline(cells, cell, ',')) cells_[name] = cell;
  }
  const std::string& text(const std::string& name) const { return cells_.at(name); }
  double operator[](const std::string& name) const { return std::strtod(text(name).c_str(), nullptr); }

 private:
  std::map<std::string, std::string> cells_;
};

std::vector<Row> read_table(const std::string& path) {
  std::istringstream in(read_text(path));
  std::string line, cell;
  std::getline(in, line);
  std::istringstream head(line);
  std::vector<std::string> names;
  while (std::getline(head, cell, ',')) names.push_back(cell);
  std::vector<Row> rows;
  while (std::getline(in, line)) rows.emplace_back(names, line);
  REQUIRE(rows.size() > 1);
  return rows;
}

std::vector<Row> of_resolver(const std::string& path, const std::string& resolver) {
  std::vector<Row> rows = read_table(path);
  rows.erase(std::remove_if(rows.begin(), rows.end(), [&](const Row& r) { return r.text("resolver") != resolver; }),
             rows.end());
  REQUIRE(!rows.empty());
  return rows;
}

/// How far a cube of 40 mm, turned about y, is in the wall at x = 30 mm or in the floor at z = -30 mm; negative: clear.
double depth_of_cube(const Row& r) {
  const double tilt = r["tilt_mrad"] / 1e3;
  const double reach = 20 * (std::abs(std::cos(tilt)) + std::abs(std::sin(tilt)));
  return std::max(r["x_mm"] + reach - 30, -30 - (r["z_mm"] - reach));
}

double deepest(const std::vector<Row>& rows) {
  double depth = -1e300;
  for (const Row& r : rows) depth = std::max(depth, depth_of_cube(r));
  return depth;
}

/// The cube is never in wall or floor and rests on both; penalty is in them, so this judge can fail. The force
/// stretches both axes alike, and draws the cube to the pen.
void judge_wall(const std::string& at) {
  for (const char* procedure : {"a", "b"}) {
    const auto table = [&](const std::string& resolver) {
      return read_table(at + "/procedure_" + procedure + "_" + resolver + ".csv");
    };
    for (const char* resolver : {"qp", "lp"}) {
      CAPTURE(procedure, resolver);
      const std::vector<Row> rows = table(resolver);
      CHECK(deepest(rows) <= kDigits);
      const Row& end = rows.back();
      CHECK(end["x_mm"] == Approx(10).margin(0.02));
      CHECK(end["z_mm"] == Approx(-10).margin(0.02));
      CHECK(end["pen_x_mm"] - end["x_mm"] > 3);
      CHECK(end["fx_n"] / (end["x_mm"] - end["pen_x_mm"]) ==
            Approx(end["fz_n"] / (end["z_mm"] - end["pen_z_mm"])).epsilon(1e-3));
      CHECK(end["fx_n"] < 0);
      // Gaps of a face that rests are kept, 2 µm at least: they differ by less over the cube's 40 mm.
      CHECK(std::abs(end["tilt_mrad"]) < 0.05);
    }
    CHECK(deepest(table("penalty")) > 0.1);
  }
}

/// At the end the tip, 25 mm below the center, is on the floor of a hole 40 mm deep, and the peg of 18.8 mm within its
/// play of 0.6 mm to each side.
void judge_insertion(const std::string& at) {
  for (const char* resolver : {"qp", "lp", "impulse", "penalty"}) {
    CAPTURE(resolver);
    const std::vector<Row> rows = read_table(at + "/insertion_0.94_" + resolver + ".csv");
    const Row& end = rows.back();
    const bool soft = std::string(resolver) == "penalty";
    CHECK(end["z_mm"] == Approx(-15).margin(soft ? 0.5 : 0.1));
    if (!soft) CHECK(end["z_mm"] >= -15 - kDigits);
    CHECK(std::hypot(end["x_mm"], end["y_mm"]) <= 0.6 + (soft ? 0.5 : kDigits));
  }
}

/// A hole of 20 mm and a peg of 99 % leave 200 um: `qp` gives no more of it, penalty more, and the more the softer.
void judge_widening(const std::string& at) {
  for (const Row& r : of_resolver(at + "/widening.csv", "qp")) {
    CHECK(r["play_um"] <= 200);
    CHECK(r["play_um"] >= 170);
  }
  const std::vector<Row> penalty = of_resolver(at + "/widening.csv", "penalty");
  CHECK(penalty.front()["play_um"] > 200 * 1.1);
  for (std::size_t i = 1; i < penalty.size(); ++i) {
    CHECK(penalty[i]["stiffness_n_per_m"] > penalty[i - 1]["stiffness_n_per_m"]);
    CHECK(penalty[i]["play_um"] < penalty[i - 1]["play_um"]);
  }
}

void judge_wrench(const std::string& at) {
  for (const Row& r : of_resolver(at + "/wrench.csv", "qp")) {
    CAPTURE(r.text("scene"));
    CHECK(r["measured"] == Approx(r["expected"]).epsilon(0.01));
    CHECK(r["direction_error_deg"] <= 0.5);
  }
  // The worst of the baseline shows that the table can tell.
  double worst = 0;
  for (const Row& r : of_resolver(at + "/wrench.csv", "lp"))
    worst = std::max(worst, std::abs(r["measured"] / r["expected"] - 1));
  CHECK(worst > 0.01);
}

void judge_hold(const std::string& at) {
  const std::vector<Row> rows = of_resolver(at + "/hold.csv", "qp");
  std::size_t touching = 0;
  for (const Row& r : rows) {
    CAPTURE(r["seed"]);
    touching += r["touching"] == 1 ? 1 : 0;
    CHECK(r["moved_um"] <= 1);
  }
  // The draws end in contact, all but a few; without contact nothing would be held.
  CHECK(2 * touching > rows.size());
}

/// Everyone gets in on every rung, sooner than the operator gives up, and is never in the wall.
void judge_ladder(const std::string& at) {
  for (const Row& r : of_resolver(at + "/ladder.csv", "qp")) {
    CAPTURE(r["ratio"], r.text("operator"), r["start"]);
    CHECK(r["clearance_um"] == Approx(20000 * (1 - r["ratio"])));
    CHECK(r["completed"] == 1);
    CHECK(r["time_s"] > 0.2);
    CHECK(r["penetration_um"] == 0);
    CHECK(r["intersecting"] == 0);
  }
}

void judge_task_time(const std::string& at) {
  for (const char* resolver : {"qp", "lp"}) {
    std::map<std::string, std::vector<double>> times;
    for (const Row& r : of_resolver(at + "/task_time.csv", resolver)) {
      CHECK(r["reached"] == 1);
      times[r.text("operator")].push_back(r["time_s"]);
    }
    // A hasty hand is faster than a careful one, or the operators are not what they are said to be.
    const auto mean = [&](const std::string& who) {
      double sum = 0;
      for (const double t : times.at(who)) sum += t;
      return sum / static_cast<double>(times.at(who).size());
    };
    CHECK(mean("hasty") < mean("careful"));
  }
}

/// Whitney's diagram by his formula (1982), and closed forms that need no program: a block on an incline slides from
/// tan b = mu on, a sliding block is held by mu N against its way whatever its heading.
void judge_friction(const std::string& at) {
  int right = 0, all = 0;
  for (const Row& r : read_table(at + "/jamming.csv")) {
    const double mu = r["mu"], lambda = r["lambda"], side = r["fx_over_fz"], moment = r["m_over_r_fz"];
    const bool slides = std::abs(side) < 1 / mu && std::abs(moment + mu * (1 + lambda) * side) < lambda;
    ++all;
    right += slides == (r["slid"] == 1) ? 1 : 0;
  }
  CHECK(right >= 0.99 * all);
  for (const Row& r : read_table(at + "/sliding.csv")) CHECK(r["ratio"] == Approx(1).epsilon(0.01));
  for (const Row& r : read_table(at + "/insertion_force.csv"))
    CHECK(r["measured_n"] == Approx(r["expected_n"]).epsilon(0.05).margin(0.01));
}

}  // namespace

bool meets(double value, const std::string& target) {
  std::istringstream words(target);
  std::string at, bound;
  double number = 0;
  if (!(words >> at >> bound >> number) || at != "at" || (bound != "most" && bound != "least"))
    throw std::invalid_argument("not a target: " + target);
  return bound == "most" ? value <= number : value >= number;
}

void judge_tables(const std::string& name, const std::string& at) {
  static const std::map<std::string, void (*)(const std::string&)> judges = {
      {"wall", judge_wall},         {"insertion", judge_insertion}, {"widening", judge_widening},
      {"wrench", judge_wrench},     {"hold", judge_hold},           {"ladder", judge_ladder},
      {"friction", judge_friction}, {"task-time", judge_task_time}};
  judges.at(name)(at);
}

}  // namespace tegotae::test
