// The table that `tegotae try` and `tegotae study` go on from: CaseTable, and what is told about the cases that it
// reads.
#include <cmath>
#include <fstream>
#include <iterator>

#include "fuzz/fuzz.hpp"
#include "study/case_table.hpp"
#include "study/outcome.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

namespace {

const study::TableLayout kLayout = {"tegotae 0.0.0, seed 1, task 0", "case", "cases", {"scene", "inward a, b_m"}};

std::string folder() {
  return (scratch_folder() / "tries").string();
}

study::Result a_try(int number, bool reached) {
  study::Result r;
  r.number = number;
  r.parameters = {"a, \"b\".toml", "1e-05"};
  r.who = "novice";
  r.route = "along the part's x";
  r.offset = 1e-3;
  r.tilt = 0.02;
  r.reached = reached;
  r.time = 12.345;
  r.depth = -0.01;
  r.force = 8;
  r.clearance = 4e-6;
  if (!reached) {
    r.blocked_by = "a \"part\", with commas";
    r.why = "blocked by a \"part\", with commas";
  }
  return r;
}

/// The table of these tries, as it is written.
std::string written(std::initializer_list<study::Result> results) {
  std::filesystem::remove_all(folder());
  study::CaseTable table(folder() + "/tries.csv", kLayout);
  for (const study::Result& r : results) table.add(r);
  table.flush();
  std::ifstream in(folder() + "/tries.csv", std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

bool same(const study::Result& a, const study::Result& b) {
  return a.number == b.number && a.parameters == b.parameters && a.clearance == b.clearance && a.why == b.why &&
         a.who == b.who && a.route == b.route && a.offset == b.offset && a.tilt == b.tilt && a.reached == b.reached &&
         a.time == b.time && a.depth == b.depth && a.force == b.force && a.torque == b.torque && a.stuck == b.stuck &&
         a.intersecting == b.intersecting && a.place_W == b.place_W;
}

}  // namespace

std::vector<Seed> seeds() {
  const std::string good = written({a_try(0, true), a_try(1, false)});
  const std::string header = good.substr(0, good.find('\n', good.find('\n') + 1) + 1);
  return {{"good", good},
          {"header_only", header},
          {"cut", good.substr(0, good.size() - 9)},
          {"negative", header + "-1,a,1,a,b,0,0,0,0,0,0,0,0,0,0,0,0,\"\",0,\"\"\n"},
          {"no_numbers", header + "0,a,1,a,b,nan,inf,1,nan,-inf,nan,0,0,0,0,0,0,\"\",0,\"\"\n"},
          {"large", header + "2147483648,a,1,a,b,1e400,0,1,1e308,0,0,0,0,0,0,0,0,\"\",0,\"\"\n"},
          {"quotes", header + "0,\",\",1,,,0,0,0,0,0,0,0,0,0,0,0,0,\"\"\",0,\"\"\n"},
          {"other_task", "# another\n" + header},
          {"empty", "\n"}};
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::filesystem::create_directories(folder());
  const std::string path = write_input("tries/tries.csv", data, size);
  try {
    study::CaseTable table(folder() + "/tries.csv", kLayout);
    if (table.rows().empty()) return 0;
    std::vector<study::Result> results;
    for (const auto& [number, r] : table.rows()) {
      require(number >= 0 && number == r.number && std::isfinite(r.time) && r.place_W.allFinite(), "a try has numbers");
      results.push_back(r);
    }
    require(study::best_case(results) != nullptr, "one of them is the best");
    require(!study::summary_text(results, "tries").empty(), "there is something to tell");
    // What is written is read again as it was.
    table.add(results.front());
    table.flush();
    const study::CaseTable again(folder() + "/tries.csv", kLayout);
    require(again.rows().size() == results.size(), "no try is lost");
    for (const study::Result& r : results) require(same(again.rows().at(r.number), r), "a try is read as it was");
  } catch (const Error& e) {
    require_error_of(path + ":", e.what());
  }
  return 0;
}

}  // namespace tegotae
