#include "shared/pose_option.hpp"

#include <charconv>
#include <cmath>
#include <vector>

#include "tegotae/core/error.hpp"

namespace tegotae::apps {

namespace {

constexpr double kLongest = 1e3;  // m: farther than any mock-up is wide

/// Empty when `text` is not a pose.
std::vector<double> numbers(const std::string& text) {
  std::vector<double> out;
  for (const char *at = text.data(), *end = at + text.size(); at <= end;) {
    double value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !(std::abs(value) <= kLongest) || (next != end && *next != ',')) return {};
    out.push_back(value);
    at = next + 1;
  }
  const bool turned = out.size() == 7 && Eigen::Map<const Eigen::Vector4d>(out.data() + 3).norm() > 1e-6;
  return out.size() == 3 || turned ? out : std::vector<double>();
}

}  // namespace

std::string goal_error(const std::string& goal) {
  if (goal == kOut || !numbers(goal).empty()) return "";
  return goal + " is not a pose: X,Y,Z in m, or with a quaternion X,Y,Z,QW,QX,QY,QZ; or \"out\"";
}

CLI::Option* add_goal_option(CLI::App& app, const std::string& name, std::string& text, const std::string& help) {
  return app.add_option(name, text, help)->check(goal_error)->type_name("POSE|out");
}

CLI::Option* add_pose_option(CLI::App& app, const std::string& name, std::string& text, const std::string& help) {
  return app.add_option(name, text, help)
      ->check([](const std::string& pose) -> std::string {
        return numbers(pose).empty() ? pose + " is not a pose: X,Y,Z in m, or with a quaternion X,Y,Z,QW,QX,QY,QZ" : "";
      })
      ->type_name("POSE");
}

Pose parse_pose(const std::string& text, const Scene& scene) {
  const std::vector<double> n = numbers(text);
  if (n.empty()) throw Error(text + ": is not a pose");
  Pose X;
  for (const Part& part : scene.parts)
    if (part.held) X = part.pose;
  X.p = Vec3(n[0], n[1], n[2]);
  if (n.size() == 7) X.q = Quat(n[3], n[4], n[5], n[6]).normalized();
  return X;
}

}  // namespace tegotae::apps
