#include <fstream>
#include <nlohmann/json.hpp>

#include "models/puzzles.hpp"
#include "plan/judge.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/import/load.hpp"

namespace tegotae::plan {
namespace {

using Json = nlohmann::json;

constexpr double kMm = 1e-3;

Pose pose_of(const Json& listed) {
  const auto r = listed.at("R_row_major").get<std::vector<double>>();
  const auto t = listed.at("t").get<std::vector<double>>();
  if (r.size() != 9 || t.size() != 3) throw Error("pairs.json: a pose needs nine numbers and three");
  Mat3 R;
  R << r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8];
  return {Quat(R).normalized(), kMm * Vec3(t[0], t[1], t[2])};
}

/// The pair where its list has it clear first.
JudgedScene pair_of(const Json& listed, const std::string& folder) {
  JudgedScene out;
  out.name = listed.at("name").get<std::string>();
  const double unit = kMm * listed.at("file_units_to_test_units_scale").get<double>();
  for (const Json& pose : listed.at("poses")) {
    if (pose.at("fcl_tri_pairs_hit").get<int>() > 0) continue;
    const std::string fixed = listed.at("fixed"), moving = listed.at("moving");
    out.scene.add_fixed("fixed", load_mesh(folder + "/" + fixed, unit));
    out.scene.add_held("moving", load_mesh(folder + "/" + moving, unit), pose_of(pose));
    return out;
  }
  throw Error("pairs.json: \"" + out.name + "\" has no clear pose");
}

}  // namespace

std::vector<JudgedScene> judged_scenes(const std::string& parts) {
  std::vector<JudgedScene> out;
  for (const shapes::Puzzle& p : shapes::puzzles()) out.push_back({p.name, p.scene(), !p.known.empty()});
  if (parts.empty()) return out;
  const std::string path = parts + "/pairs.json";
  std::ifstream in(path);
  if (!in) throw Error(path + ": cannot be read");
  try {
    for (const Json& listed : Json::parse(in)) out.push_back(pair_of(listed, parts));
  } catch (const Json::exception& e) {
    throw Error(path + ": " + e.what());
  }
  return out;
}

}  // namespace tegotae::plan
