#include "loop/containment_test.hpp"

#include <algorithm>

#include "mesh/components.hpp"
#include "narrowphase/patch_cache.hpp"

namespace tegotae {

ContainmentTest::Side::Side(const std::shared_ptr<const TriangleMesh>& mesh) {
  auto surface = cached_surface(mesh);
  const Components parts = components(*mesh, surface->topology);
  std::vector<bool> seen(parts.count, false);
  for (std::size_t f = 0; f < mesh->triangles.size(); ++f) {
    const std::uint32_t part = parts.of[f];
    if (part == kNone || seen[part]) continue;
    seen[part] = true;
    points.push_back(mesh->vertices[mesh->triangles[f][0]]);
  }
  if (is_closed(surface->topology))
    distance = std::make_unique<SignedDistance>(std::move(surface), cached_patch_tree(mesh));
}

ContainmentTest::ContainmentTest(const std::shared_ptr<const TriangleMesh>& a,
                                 const std::shared_ptr<const TriangleMesh>& b)
    : a_(a), b_(b) {}

bool ContainmentTest::inside(const Pose& X_BA) const noexcept {
  return any_inside(a_, b_, X_BA) || any_inside(b_, a_, X_BA.inverse());
}

bool ContainmentTest::any_inside(const Side& inner, const Side& outer, const Pose& X) noexcept {
  return outer.distance && std::any_of(inner.points.begin(), inner.points.end(),
                                       [&](const Vec3& p) { return outer.distance->at(X * p, 0).distance < 0; });
}

}  // namespace tegotae
