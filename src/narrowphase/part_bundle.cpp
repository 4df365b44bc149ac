#include "narrowphase/part_bundle.hpp"

#include <algorithm>

#include "narrowphase/patch_cache.hpp"

namespace tegotae {

PartBundle::PartBundle(const std::vector<std::shared_ptr<const TriangleMesh>>& fixed, const std::vector<Pose>& poses,
                       const std::vector<std::uint32_t>& members)
    : members_(members), is_member_(fixed.size(), false) {
  auto all = std::make_shared<TriangleMesh>();
  all->name = "fixed parts";
  for (const std::uint32_t part : members_) {
    is_member_[part] = true;
    first_face_.push_back(static_cast<std::uint32_t>(all->triangles.size()));
    const auto first_vertex = static_cast<std::uint32_t>(all->vertices.size());
    for (const Vec3& v : fixed[part]->vertices) all->vertices.push_back(poses[part] * v);
    for (const auto& t : fixed[part]->triangles)
      all->triangles.push_back({first_vertex + t[0], first_vertex + t[1], first_vertex + t[2]});
  }
  tree_ = cached_patch_tree(all);
}

FacePair PartBundle::of_part(const FacePair& pair) const noexcept {
  const auto after = std::upper_bound(first_face_.begin(), first_face_.end(), pair.b);
  const auto member = static_cast<std::size_t>(after - first_face_.begin()) - 1;
  return {members_[member], pair.a, pair.b - first_face_[member]};
}

}  // namespace tegotae
