#include "narrowphase/piece_counts.hpp"

#include <algorithm>
#include <cmath>

namespace tegotae {
namespace {

/// Grades of thickness: so many for each doubling of it, from the thinnest on (m).
constexpr int kPerOctave = 4, kGrades = 40 * kPerOctave;
constexpr double kThinnest = 1e-9;

std::size_t grade(double half_thickness) {
  const double above = std::log2(std::max(half_thickness, kThinnest) / kThinnest);
  return static_cast<std::size_t>(std::min(kPerOctave * above, kGrades - 1.0));
}

}  // namespace

PieceCounts::PieceCounts(const PatchTree& tree) : up_to_(kGrades, 0) {
  const std::vector<PatchNode>& nodes = tree.nodes();
  // A node is as thick as the thickest below it. Its children come after it.
  std::vector<float> thick(nodes.size());
  for (std::size_t i = nodes.size(); i-- > 0;) {
    thick[i] = nodes[i].half[2];
    if (nodes[i].leaf()) continue;
    const std::size_t child = nodes[i].first;
    thick[i] = std::max({thick[i], thick[child], thick[child + 1]});
    // From where it is thin enough, the node stands for its children.
    --up_to_[grade(thick[i])];
  }
  // Leaves are pieces however thin pieces may be: nothing takes them apart.
  const auto leaves = std::count_if(nodes.begin(), nodes.end(), [](const PatchNode& n) { return n.leaf(); });
  int count = static_cast<int>(leaves);
  for (int& n : up_to_) n = count += n;
}

int PieceCounts::at(double half_thickness) const noexcept {
  return up_to_[grade(half_thickness)];
}

}  // namespace tegotae
