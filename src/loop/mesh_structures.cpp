#include "loop/mesh_structures.hpp"

#include <algorithm>

#include "core/parallel_for.hpp"
#include "narrowphase/patch_cache.hpp"

namespace tegotae {

MeshStructures::MeshStructures(const std::vector<Part>& parts, NarrowPhase narrowphase,
                               const std::function<void(std::size_t done, std::size_t total)>& progress) {
  const bool with_trees = narrowphase != NarrowPhase::fcl;
  std::vector<std::shared_ptr<const TriangleMesh>> meshes;
  for (const Part& p : parts)
    if (p.mesh && !p.mesh->triangles.empty() && surfaces.emplace(p.mesh.get(), nullptr).second)
      meshes.push_back(p.mesh);
  // The longest jobs first.
  std::stable_sort(meshes.begin(), meshes.end(),
                   [](const auto& p, const auto& q) { return p->triangles.size() > q->triangles.size(); });
  for (const auto& mesh : meshes)
    if (with_trees) trees[mesh.get()];
  const auto n = static_cast<int>(meshes.size()), jobs = with_trees ? 2 * n : n;
  const auto make = [&](int i) {
    const auto& mesh = meshes[static_cast<std::size_t>(i % n)];
    if (with_trees && i < n)
      trees.at(mesh.get()) = cached_patch_tree(mesh);
    else
      surfaces.at(mesh.get()) = cached_surface(mesh);
  };
  const auto report = [&](int done) {
    if (progress) progress(static_cast<std::size_t>(done), static_cast<std::size_t>(jobs));
  };
  report(0);
  parallel_for(jobs, 0, make, report);
}

}  // namespace tegotae
