#include "narrowphase/patch_cache.hpp"

#include <array>
#include <cstdlib>
#include <string>
#include <utility>

#include "mesh/cache_entry.hpp"
#include "mesh/in_use.hpp"
#include "mesh/mesh_key.hpp"
#include "tegotae/narrowphase/hierarchy_cache.hpp"

namespace tegotae {
namespace {

/// What of a tree is not a list. Fixed size, no padding.
struct Head {
  std::uint64_t leaf = kPatchLeaf;
  std::array<double, 3> origin{};
  double radius = 0;
};
static_assert(sizeof(Head) == 40 && std::is_trivially_copyable_v<PatchNode>);

/// Whether every index leads somewhere, children lie behind their parents, and the leaves hold each face once.
bool is_sound(const std::vector<PatchNode>& nodes, const std::vector<std::uint32_t>& order, std::size_t faces) {
  if (nodes.empty() || order.size() != faces) return false;
  std::vector<bool> seen(order.size(), false);
  for (const std::uint32_t face : order) {
    if (face >= order.size() || seen[face]) return false;
    seen[face] = true;
  }
  std::uint64_t places = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const PatchNode& n = nodes[i];
    places += n.count;
    if (n.leaf() ? std::uint64_t{n.first} + n.count > order.size()
                 : n.first <= i || std::uint64_t{n.first} + 2 > nodes.size())
      return false;
  }
  return places == order.size();
}

std::shared_ptr<const PatchTree> load(const CacheName& name, const std::shared_ptr<const TriangleMesh>& mesh) {
  CacheReader entry(name);
  Head head;
  std::vector<PatchNode> nodes;
  std::vector<std::uint32_t> order;
  const bool whole = entry.take_value(head) && entry.take(nodes) && entry.take(order) && entry.done();
  if (!whole || head.leaf != kPatchLeaf || !is_sound(nodes, order, mesh->triangles.size())) return nullptr;
  const Vec3 origin(head.origin[0], head.origin[1], head.origin[2]);
  return std::make_shared<const PatchTree>(mesh, std::move(nodes), std::move(order), origin, head.radius);
}

void store(const CacheName& name, const PatchTree& tree) {
  CacheWriter entry(name);
  entry.put_value(Head{kPatchLeaf, {tree.origin().x(), tree.origin().y(), tree.origin().z()}, tree.radius()});
  entry.put(tree.nodes());
  entry.put(tree.order());
  entry.keep();
}

std::shared_ptr<const PatchTree> stored_or_built(const std::shared_ptr<const TriangleMesh>& mesh) {
  if (!has_cache_folder() || mesh->triangles.size() < kMinCached) return std::make_shared<const PatchTree>(mesh);
  const CacheName name{"patch", kPatchBuild, key_of(*mesh)};
  if (auto tree = load(name, mesh)) return tree;
  auto tree = std::make_shared<const PatchTree>(mesh);
  store(name, *tree);
  return tree;
}

}  // namespace

void set_hierarchy_cache(const std::string& path) {
  set_cache_folder(path);
}

std::string default_cache_folder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && cache[0] == '/') return std::string(cache) + "/tegotae";
  const char* home = std::getenv("HOME");
  return home != nullptr && home[0] == '/' ? std::string(home) + "/.cache/tegotae" : "";
}

std::shared_ptr<const PatchTree> cached_patch_tree(const std::shared_ptr<const TriangleMesh>& mesh) {
  static InUse<const TriangleMesh*, PatchTree> in_use;
  return in_use.get(mesh.get(), [&] { return stored_or_built(mesh); });
}

}  // namespace tegotae
