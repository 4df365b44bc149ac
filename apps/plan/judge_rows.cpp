#include "plan/judge_rows.hpp"

#include <fstream>
#include <iterator>
#include <utility>

#include "core/output_file.hpp"
#include "mesh/content_sum.hpp"
#include "shared/format.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::plan {
namespace {

using OrderedJson = nlohmann::ordered_json;

template <class T>
void add(ContentSum& sum, const T& value) {
  sum.add(&value, sizeof value);
}

void add(ContentSum& sum, const Part& part) {
  add(sum, part.held);
  for (const double x : part.pose.p) add(sum, x);
  for (const double x : part.pose.q.coeffs()) add(sum, x);
  for (const Vec3& v : part.mesh->vertices)
    for (const double x : v) add(sum, x);
  for (const auto& t : part.mesh->triangles) add(sum, t);
}

std::string this_program() {
  std::ifstream in("/proc/self/exe", std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

OrderedJson to_json(const PlannerFigures& f) {
  return {{"found", f.found},         {"cpu", f.cpu},
          {"whole_cpu", f.whole_cpu}, {"checked", f.checked},
          {"bad_paths", f.bad_paths}, {"intersecting", f.intersecting},
          {"clearance", f.clearance}};
}

PlannerFigures figures_of(const OrderedJson& j) {
  PlannerFigures f;
  j.at("found").get_to(f.found);
  j.at("cpu").get_to(f.cpu);
  j.at("whole_cpu").get_to(f.whole_cpu);
  j.at("checked").get_to(f.checked);
  j.at("intersecting").get_to(f.intersecting);
  j.at("bad_paths").get_to(f.bad_paths);
  j.at("clearance").get_to(f.clearance);
  return f;
}

}  // namespace

std::string judged_from(const JudgedScene& scene, const JudgeOptions& options) {
  static const std::string program = this_program();
  if (program.empty()) throw Error("this program's own file cannot be read");
  ContentSum sum;
  sum.add(program.data(), program.size());
  add(sum, options.seeds);
  add(sum, options.seconds);
  for (const Part& part : scene.scene.parts) add(sum, part);
  const ContentKey key = sum.key();
  return apps::format("%016llx%016llx", static_cast<unsigned long long>(key[0]),
                      static_cast<unsigned long long>(key[1]));
}

JudgeRows::JudgeRows(std::string path) : path_(std::move(path)) {
  if (path_.empty()) return;
  std::ifstream in(path_);
  if (!in) return;
  try {
    rows_ = OrderedJson::parse(in);
  } catch (const OrderedJson::exception& e) {
    throw Error(path_ + ": " + e.what());
  }
}

std::optional<JudgedFigures> JudgeRows::find(const std::string& scene, const std::string& from) const {
  try {
    const auto row = rows_.find(scene);
    if (row == rows_.end() || row->at("from") != from) return std::nullopt;
    return JudgedFigures{figures_of(row->at("ours")), figures_of(row->at("baseline"))};
  } catch (const OrderedJson::exception& e) {
    throw Error(path_ + ": \"" + scene + "\": " + e.what());
  }
}

void JudgeRows::keep(const std::string& scene, const std::string& from, const JudgedFigures& figures) {
  if (path_.empty()) return;
  rows_[scene] = {{"from", from}, {"ours", to_json(figures.ours)}, {"baseline", to_json(figures.baseline)}};
  write_file(path_, rows_.dump(1) + "\n");
}

}  // namespace tegotae::plan
