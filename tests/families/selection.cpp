#include "families/selection.hpp"

#include <cmath>

#include "families/family_tools.hpp"

namespace tegotae::test {
namespace {

constexpr int kTriangles[] = {2000, 1000, 5000, 20000, 10000, 50000, 2000, 100000, 200000, 500000};
constexpr double kClearances[] = {0, 0.1e-3, 0.02e-3, 0.5e-3};
constexpr int kFixedParts[] = {1, 9, 64, 4, 144, 400, 36, 2000, 100, 1024};
constexpr double kSmallest = 2e-3, kLargest = 2;  // m

/// Spread over the list in turn, another turn for each family.
FamilyParameters drawn(const std::string& family, std::size_t number, unsigned seed) {
  FamilyParameters p;
  p.family = family;
  p.seed = seed;
  const std::size_t i = seed - 1;
  p.triangles = kTriangles[i % std::size(kTriangles)];
  p.clearance = kClearances[(i + number) % std::size(kClearances)];
  p.near = kFixedParts[(i + number) % std::size(kFixedParts)];
  p.size = kSmallest * std::pow(kLargest / kSmallest, draw(p, 100 + static_cast<unsigned>(number)));
  return p;
}

FamilyParameters daily(const std::string& family, unsigned seed, int triangles, double clearance, double size,
                       int near) {
  FamilyParameters p;
  p.family = family;
  p.seed = seed;
  p.triangles = triangles;
  p.clearance = clearance;
  p.size = size;
  p.near = near;
  return p;
}

}  // namespace

std::vector<SelectedCase> daily_cases() {
  const CaseOptions virtual_time = {}, real_time = {true, {}};
  std::vector<SelectedCase> cases;
  unsigned seed = 1;
  for (const std::string& family : family_names())
    cases.push_back({daily(family, seed++, 2000, 0.05e-3, 0.1, 4), virtual_time});
  // The size that the issues of conforming parts were found at.
  cases.push_back({daily("wave", 1, 7000, 0, 0.3, 1), virtual_time});
  cases.push_back({daily("ball", 1, 20000, 0.05e-3, 0.04, 1), virtual_time});
  // More work in one motion than a tick of virtual time once did.
  cases.push_back({daily("noise", 4, 20000, 0.1e-3, 0.129, 1), virtual_time});
  for (const int near : {36, 64, 144, 2000}) cases.push_back({daily("cover", 1, 12, 0, 0.12, near), virtual_time});
  cases.push_back({daily("cover", 1, 12, 0, 0.12, 144), real_time});
  // What is in the way of all these parts takes more than a tick to be told.
  cases.push_back({daily("cover", 3, 5000, 0, 0.058, 144), real_time});
  return cases;
}

std::vector<SelectedCase> all_cases(int seeds, bool real_time) {
  std::vector<SelectedCase> cases;
  // Full-area contact under a fast pen in real time, which docs/limits.md says is missed: not of every day.
  if (real_time) {
    cases.push_back({daily("wave", 1, 7000, 0, 0.3, 1), {true, {}}});
    cases.push_back({daily("ball", 1, 20000, 0.05e-3, 0.04, 1), {true, {}}});
  }
  const std::vector<std::string> names = family_names();
  for (int seed = 1; seed <= seeds; ++seed)
    for (std::size_t i = 0; i < names.size(); ++i)
      cases.push_back({drawn(names[i], i, static_cast<unsigned>(seed)), {real_time, {}}});
  return cases;
}

}  // namespace tegotae::test
