#include "view/page_parts.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "broadphase/bounding_spheres.hpp"
#include "core/whole_number.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::view {
namespace {

// A part farther from the world's origin (m), or turned by more than this (rad) at once, is a mistake.
constexpr double kFarthestPart = 100, kMaxTurn = 10;

Vec3 three(const nlohmann::json& values, double most) {
  if (!values.is_array() || values.size() != 3) throw Error("a move has three numbers");
  Vec3 v;
  for (int i = 0; i < 3; ++i) {
    v[i] = values[static_cast<std::size_t>(i)].get<double>();
    if (!(std::abs(v[i]) <= most)) throw Error("a move is out of range");
  }
  return v;
}

Pose moved(const Part& part, const Vec3& by, const Vec3& turn) {
  const Vec3 middle = bounding_sphere(*part.mesh).center;
  const Quat q = (Eigen::AngleAxisd(turn.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(turn.y(), Vec3::UnitY()) *
                  Eigen::AngleAxisd(turn.x(), Vec3::UnitX()) * part.pose.q)
                     .normalized();
  const Vec3 p = part.pose * middle + by - q * middle;
  if (!(p.cwiseAbs().maxCoeff() <= kFarthestPart)) throw Error("a move is out of range");
  return {turn.isZero(0) ? part.pose.q : q, turn.isZero(0) ? Vec3(part.pose.p + by) : p};
}

}  // namespace

std::size_t PageParts::held() const {
  const auto held = std::find_if(parts_.begin(), parts_.end(), [](const Part& p) { return p.held; });
  return static_cast<std::size_t>(held - parts_.begin());
}

void PageParts::put_down(const Pose& X) {
  Part& part = parts_[held()];
  part.held = false;
  part.pose = X;
}

void PageParts::edit(const nlohmann::json& command) {
  const std::string what = command.at("do");
  const auto number = whole_number<std::int64_t>(command.at("part"));
  if (number < 0 || static_cast<std::size_t>(number) >= parts_.size()) throw Error("there is no such part");
  const auto i = static_cast<std::size_t>(number);
  Part& part = parts_[i];
  if (what == "add") {
    if (!removed_[i]) throw Error(part.name + " is in the scene");
    removed_[i] = false;
    return;
  }
  if (removed_[i]) throw Error(part.name + " is not in the scene; add it first");
  if (part.held) throw Error(part.name + " is held, so the pen moves it; hold another part first");
  if (what == "hold") {
    if (any_held()) parts_[held()].held = false;
    part.held = true;
  } else if (what == "remove") {
    removed_[i] = true;
  } else {
    part.pose = moved(part, three(command.at("by"), kFarthestPart), three(command.at("turn"), kMaxTurn));
  }
}

std::vector<std::uint32_t> PageParts::numbers() const {
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t i = 0; i < parts_.size(); ++i)
    if (!removed_[i]) numbers.push_back(i);
  return numbers;
}

std::vector<Part> PageParts::in_scene() const {
  std::vector<Part> parts;
  for (const std::uint32_t i : numbers()) parts.push_back(parts_[i]);
  return parts;
}

void PageParts::place(const std::vector<Part>& in_scene) {
  const std::vector<std::uint32_t> where = numbers();
  for (std::size_t i = 0; i < where.size(); ++i) parts_[where[i]].pose = in_scene[i].pose;
}

}  // namespace tegotae::view
