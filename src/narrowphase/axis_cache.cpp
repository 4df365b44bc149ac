#include "narrowphase/axis_cache.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "mesh/cache_entry.hpp"
#include "mesh/mesh_key.hpp"
#include "narrowphase/patch_cache.hpp"

namespace tegotae {
namespace {

// To be raised whenever find_axes() or ProfileTree makes something else of the same mesh, tree and frame.
constexpr std::uint32_t kAxesBuild = 1, kProfileBuild = 1;
// Finding axes takes 40 ms in a mesh of some hundred triangles already, and an entry of them is small.
constexpr std::size_t kMinForAxes = 200;

static_assert(sizeof(ScrewAxis) == 8 * sizeof(double) && std::is_trivially_copyable_v<ProfileBox>);

CacheName name_of(const PatchTree& tree, const ScrewFrame& frame) {
  const ContentKey mesh = key_of(tree.mesh());
  ContentSum sum;
  sum.add(&mesh, sizeof mesh);
  sum.add(&kPatchBuild, sizeof kPatchBuild);
  sum.add(frame.R.data(), 9 * sizeof(double));
  sum.add(frame.origin.data(), 3 * sizeof(double));
  sum.add(&frame.rise, sizeof frame.rise);
  return {"profile", kProfileBuild, sum.key()};
}

std::optional<ProfileTree> load(const CacheName& name, const PatchTree& tree, const ScrewFrame& frame) {
  CacheReader entry(name);
  std::vector<std::uint32_t> place;
  std::vector<ProfileBox> boxes;
  if (!entry.take(place) || !entry.take(boxes) || !entry.done() || place.size() != tree.nodes().size() ||
      !std::all_of(place.begin(), place.end(),
                   [&](std::uint32_t p) { return p < boxes.size() || p == ProfileTree::kNone; }))
    return std::nullopt;
  return ProfileTree(frame, std::move(place), std::move(boxes));
}

}  // namespace

std::vector<ScrewAxis> cached_axes(const TriangleMesh& mesh) {
  if (!has_cache_folder() || mesh.triangles.size() < kMinForAxes) return find_axes(mesh);
  const CacheName name{"axes", kAxesBuild, key_of(mesh)};
  std::vector<ScrewAxis> axes;
  CacheReader kept(name);
  if (kept.take(axes) && kept.done()) return axes;
  axes = find_axes(mesh);
  CacheWriter entry(name);
  entry.put(axes);
  entry.keep();
  return axes;
}

ProfileTree cached_profile(const PatchTree& tree, const ScrewFrame& frame) {
  if (!has_cache_folder() || tree.order().size() < kMinCached) return ProfileTree(tree, frame);
  const CacheName name = name_of(tree, frame);
  if (auto kept = load(name, tree, frame)) return std::move(*kept);
  ProfileTree built(tree, frame);
  CacheWriter entry(name);
  entry.put(built.places());
  entry.put(built.all_boxes());
  entry.keep();
  return built;
}

}  // namespace tegotae
