// The table that `tegotae try` goes on from: TryTable, and what is told about the tries that it reads.
#include <cmath>
#include <fstream>
#include <iterator>

#include "fuzz/fuzz.hpp"
#include "tegotae/core/error.hpp"
#include "tries/try_report.hpp"
#include "tries/try_table.hpp"

namespace tegotae {

namespace {

constexpr const char* kTask = "tegotae 0.0.0, seed 1, task 0";

std::string folder() {
  return (scratch_folder() / "tries").string();
}

tries::Result a_try(int number, bool reached) {
  tries::Result r;
  r.number = number;
  r.who = "novice";
  r.route = "along the part's x";
  r.offset = 1e-3;
  r.tilt = 0.02;
  r.reached = reached;
  r.time = 12.345;
  r.depth = -0.01;
  r.force = 8;
  if (!reached) r.blocked_by = "a \"part\", with commas";
  return r;
}

/// The table of these tries, as it is written.
std::string written(std::initializer_list<tries::Result> results) {
  std::filesystem::remove_all(folder());
  tries::TryTable table(folder(), kTask);
  for (const tries::Result& r : results) table.add(r);
  std::ifstream in(folder() + "/tries.csv", std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

bool same(const tries::Result& a, const tries::Result& b) {
  return a.number == b.number && a.who == b.who && a.route == b.route && a.offset == b.offset && a.tilt == b.tilt &&
         a.reached == b.reached && a.time == b.time && a.depth == b.depth && a.force == b.force &&
         a.torque == b.torque && a.stuck == b.stuck && a.intersecting == b.intersecting && a.place_W == b.place_W;
}

}  // namespace

std::vector<Seed> seeds() {
  const std::string good = written({a_try(0, true), a_try(1, false)});
  const std::string header = good.substr(0, good.find('\n', good.find('\n') + 1) + 1);
  return {
      {"good", good},
      {"header_only", header},
      {"cut", good.substr(0, good.size() - 9)},
      {"negative", header + "-1,a,b,0,0,0,0,0,0,0,0,0,0,0,0,\"\"\n"},
      {"no_numbers", header + "0,a,b,nan,inf,1,nan,-inf,nan,0,0,0,0,0,0,\"\"\n1,a,b,0,0,1,nan,0,0,0,0,0,0,0,0,\"\"\n"},
      {"large", header + "2147483648,a,b,1e400,0,1,1e308,0,0,0,0,0,0,0,0,\"\"\n"},
      {"quotes", header + "0,,,0,0,0,0,0,0,0,0,0,0,0,0,\"\"\"\n"},
      {"other_task", "# another\n" + header},
      {"empty", "\n"}};
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::filesystem::create_directories(folder());
  const std::string path = write_input("tries/tries.csv", data, size);
  try {
    tries::TryTable table(folder(), kTask);
    if (table.rows().empty()) return 0;
    std::vector<tries::Result> results;
    for (const auto& [number, r] : table.rows()) {
      require(number >= 0 && number == r.number && std::isfinite(r.time) && r.place_W.allFinite(), "a try has numbers");
      results.push_back(r);
    }
    require(tries::best_try(results) != nullptr, "one of them is the best");
    require(!tries::summary_text(results).empty(), "there is something to tell");
    // What is written is read again as it was.
    table.add(results.front());
    const tries::TryTable again(folder(), kTask);
    require(again.rows().size() == results.size(), "no try is lost");
    for (const tries::Result& r : results) require(same(again.rows().at(r.number), r), "a try is read as it was");
  } catch (const Error& e) {
    const std::string what = e.what();
    require(what.rfind(path + ":", 0) == 0, "the error begins with the file");
    require(what.find('\n') == std::string::npos, "the error is one line");
  }
  return 0;
}

}  // namespace tegotae
