#include "sim/start_check.hpp"

#include "narrowphase/containment.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/mesh/report.hpp"

namespace tegotae {
namespace {

// Enough to count them all in practice; a message need not be exact beyond it.
constexpr int kMostCounted = 1000000;

bool inside(const Part& inner, const Part& outer) {
  if (!report(*outer.mesh).closed) return false;
  const Vec3 point = outer.pose.inverse() * (inner.pose * inner.mesh->vertices.front());
  return std::abs(winding_number(*outer.mesh, point)) > 0.5;
}

}  // namespace

void check_start(const Part& held, const std::vector<const Part*>& fixed, FclNarrowPhase& narrow) {
  std::vector<FacePair> pairs;
  for (std::uint32_t i = 0; i < fixed.size(); ++i) {
    const Part& other = *fixed[i];
    const std::string names = "\"" + held.name + "\" and \"" + other.name + "\"";
    const int n = narrow.intersections(i, other.pose.inverse() * held.pose, kMostCounted, pairs);
    if (n > 0)
      throw Error("parts " + names + " intersect at the start (" + std::to_string(n) +
                  " intersecting triangle pairs); move the held part to a free position");
    pairs.clear();
    if (inside(held, other) || inside(other, held))
      throw Error("of the parts " + names +
                  " one starts inside the other (0 intersecting triangle pairs); move the "
                  "held part to a free position");
  }
}

}  // namespace tegotae
