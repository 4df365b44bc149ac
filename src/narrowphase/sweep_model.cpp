#include "narrowphase/sweep_model.hpp"

#include <algorithm>
#include <map>

namespace tegotae {

SweepModel::Surface::Surface(const PatchTree& tree) : blocks(tree), slabs(tree, blocks) {
  lanes.reserve(blocks.count());
  for (std::uint32_t block = 0; block < blocks.count(); ++block) lanes.emplace_back(tree, blocks, block);
}

SweepModel::SweepModel(std::shared_ptr<const PatchTree> held, const Vec3& center_of_a,
                       const std::vector<CellFront::FixedPart>& fixed, std::shared_ptr<const Facing> facing_of_a,
                       std::shared_ptr<const Backing> backing_of_a)
    : a(std::move(held)),
      facing(std::move(facing_of_a)),
      backing(std::move(backing_of_a)),
      surface_of_a(std::make_shared<Surface>(*a)),
      center(center_of_a),
      reach(a->radius() + (a->origin() - center).norm()) {
  if (facing) facing_cones = cones_of(facing->faces());
  if (backing) {
    backing_cones = cones_of(backing->faces());
    for (const Backing::Side side : {Backing::Side::plus, Backing::Side::minus})
      if (const auto& tree = backing->walls(side))
        walls[static_cast<std::size_t>(side)] = std::make_shared<Surface>(*tree);
    reach += backing->drawn(Backing::Side::plus).norm();
  }
  std::map<const PatchTree*, std::shared_ptr<const Surface>> known = {{a.get(), surface_of_a}};
  for (const CellFront::FixedPart& part : fixed) {
    auto& own = known[part.tree.get()];
    if (!own && part.tree->mesh().triangles.size() <= kMostFaces) own = std::make_shared<Surface>(*part.tree);
    parts.push_back({part.tree, own, part.pose});
  }
}

SweepModel::Cones SweepModel::cones_of(const std::vector<NormalCone>& faces) const {
  Cones cones{&faces, {}};
  const FaceBlocks& blocks = surface_of_a->blocks;
  std::uint32_t each = 1;
  for (std::uint32_t level = 0; level < surface_of_a->slabs.levels(); ++level, each *= FaceBlocks::kFan) {
    cones.nodes.emplace_back();
    for (std::uint32_t first = 0; first < blocks.count(); first += each) {
      std::vector<std::uint32_t> under;
      for (std::uint32_t block = first; block < std::min(first + each, blocks.count()); ++block)
        for (std::uint32_t k = 0; k < blocks.faces(block); ++k) under.push_back(blocks.face(block, k));
      cones.nodes.back().push_back(NormalCone::around(faces, under));
    }
  }
  return cones;
}

}  // namespace tegotae
