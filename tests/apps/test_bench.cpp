// `tegotae bench`: the shape of its report, and that the runs it times stay free. Times are not looked at.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/run_program.hpp"
#include "catch.hpp"

using namespace tegotae::test;
using nlohmann::json;

namespace {

void check_ordered(const json& p, const std::vector<const char*>& keys) {
  double last = 0;
  for (const char* key : keys) {
    INFO(key);
    CHECK(p.at(key).get<double>() >= last);
    last = p.at(key).get<double>();
  }
}

}  // namespace

TEST_CASE("the smallest scene gives a whole report", "[bench]") {
  const TempFolder folder;
  folder.write("page.md", "before\n<!-- begin generated -->\nold\n<!-- end generated -->\nafter\n");
  const Output o = run_program("tegotae", "bench --quick --json --scene 2k/2k@0.99 --markdown " + (folder / "page.md"));
  INFO("stderr: " << o.err);
  REQUIRE(o.code == 0);
  CHECK(o.err.empty());
  REQUIRE(std::count(o.out.begin(), o.out.end(), '\n') == 1);
  const json j = json::parse(o.out);

  REQUIRE(j.at("rows").size() == 1);
  const json& row = j.at("rows").at(0);
  CHECK(row.at("scene") == "2k/2k@0.99");
  CHECK(row.at("triangles") == json({2000, 2006}));
  for (const json& run : {row, row.at("fast")}) {
    check_ordered(run.at("tick_us"), {"p50", "p99", "p999", "max"});
    check_ordered(run.at("tick_cpu_us"), {"p50", "p99", "p999", "max"});
    CHECK(run.at("cut").is_number_integer());
    CHECK(run.at("contacts").get<double>() > 0);
    CHECK(run.at("ticks_in_contact").get<int>() <= run.at("ticks").get<int>());
    CHECK(run.at("resolves").get<double>() >= 1);
    const json& lag = run.at("lag");
    check_ordered(lag, {"p50_m", "p99_m", "max_m"});
    CHECK(lag.at("force_rms_n").get<double>() > 0.01);  // the pen presses
    CHECK(lag.at("force_error_share").get<double>() ==
          Approx(lag.at("force_error_rms_n").get<double>() / lag.at("force_rms_n").get<double>()));
    CHECK(lag.at("force_error_max_n").get<double>() >= lag.at("force_error_rms_n").get<double>());
  }
  CHECK(row.at("ticks_in_contact").get<int>() > 100);
  check_ordered(row.at("fcl_us"), {"p50", "p99"});
  CHECK(row.at("fcl_overlapping") == row.at("fcl_poses"));
  CHECK(row.at("bytes_per_triangle").get<double>() > 0);
  CHECK(row.at("depth_m").get<double>() <= 0.040);  // the hole's
  CHECK(row.at("checked").get<int>() > 100);
  CHECK(row.at("intersecting") == 0);

  REQUIRE(j.at("lp").size() == 2);
  for (const json& lp : j.at("lp")) {
    CHECK(lp.at("us").get<double>() > 0);
    CHECK((lp.at("glpk_us").is_null() || lp.at("glpk_us").get<double>() > 0));
    CHECK(lp.at("gap").get<double>() < 1e-9);
    CHECK(lp.at("failed") == 0);
  }

  const std::string page = read_text(folder / "page.md");
  CHECK(page.substr(0, 7) == "before\n");
  CHECK(page.find("| `2k/2k@0.99` |") != std::string::npos);
  CHECK(page.find("old\n") == std::string::npos);
  CHECK(page.substr(page.size() - 6) == "after\n");
  CHECK(read_text(folder / "page.svg").find("<svg ") == 0);
}

TEST_CASE("a scene with a seat says how the part comes to it, slides on it, and leaves it", "[bench]") {
  const Output o = run_program("tegotae", "bench --quick --json --scene cover200");
  INFO("stderr: " << o.err);
  REQUIRE(o.code == 0);
  const json row = json::parse(o.out).at("rows").at(0);
  CHECK(row.at("triangles") == json({12, 2400}));
  CHECK(row.at("checked").get<int>() > 100);
  CHECK(row.at("intersecting") == 0);
  const json& seat = row.at("seat");
  check_ordered(seat.at("rest_us"), {"p50", "p99", "p999", "max"});
  CHECK(seat.at("cut").get<int>() <= seat.at("ticks").get<int>());
  CHECK(seat.at("above_seat_m").get<double>() >= 0);
  for (const char* key : {"arrival_ms", "slide_mm_s", "off_ms"}) {
    INFO(key);
    CHECK((seat.at(key).is_null() || seat.at(key).get<double>() >= 0));
  }
}

TEST_CASE("the start is measured for three formats", "[bench]") {
  const Output o = run_program("tegotae", "bench --quick --json --scene start");
  CHECK(o.code == 0);
  const json j = json::parse(o.out);
  CHECK(j["rows"].empty());
  REQUIRE(j["starts"].size() == 3);
  for (const json& start : j["starts"]) {
    CHECK(start["triangles"].get<int>() >= 20000);
    CHECK(start["first_s"].get<double>() > 0);
    CHECK(start["second_s"].get<double>() > 0);
  }
}

TEST_CASE("an unknown scene is bad usage", "[bench]") {
  const Output o = run_program("tegotae", "bench --scene 3k/3k");
  CHECK(o.code == 2);
  CHECK(o.out.empty());
  CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
}
