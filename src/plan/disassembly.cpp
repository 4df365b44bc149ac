#include "plan/disassembly.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "broadphase/bounding_spheres.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

using Parts = std::vector<std::size_t>;

// Parts that stop one, with each of which it is tried as a group; and parts of a group at most.
constexpr std::size_t kPartners = 3, kMaxGroup = 5;

bool has(const Parts& parts, std::size_t part) {
  return std::find(parts.begin(), parts.end(), part) != parts.end();
}

class Taking {
 public:
  Taking(const Scene& scene, const DisassemblyOptions& options) : scene_(scene), options_(options) {}

  void take_all() {
    Parts all;
    for (std::size_t i = 0; i < scene_.parts.size(); ++i) all.push_back(i);
    // Small ones first: what is left is what a person would call the base.
    std::stable_sort(all.begin(), all.end(), [this](std::size_t a, std::size_t b) { return radius(a) < radius(b); });
    out_.left = take(std::move(all));
  }

  Disassembly result() {
    for (auto& [parts, blocked] : blocked_)
      if (parts.size() == 1) out_.blocked.push_back(std::move(blocked));
    out_.interrupted = stopped();
    return std::move(out_);
  }

 private:
  double radius(std::size_t part) const { return bounding_sphere(*scene_.parts[part].mesh).radius; }

  /// Takes out of what is `there` what comes out; returns the rest.
  Parts take(Parts there) {
    while (there.size() > 1 && !stopped())
      if (!take_single(there, options_.quick) && !take_single(there, options_.iterations) && !take_group(there)) break;
    return there;
  }

  bool stopped() const { return options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed); }

  /// Whether `parts` come out of what is `there`; then they are taken from it. Else blocked_ has why, by the parts.
  bool try_out(Parts& there, const Parts& parts, std::int64_t iterations) {
    if (options_.progress) options_.progress(parts, there.size());
    PlanOptions options;
    options.clearance = options_.clearance;
    options.seed = options_.seed;
    options.iterations = iterations;
    options.stop = options_.stop;
    if (options_.progress) options.progress = [&](const PlanProgress&) { options_.progress(parts, there.size()); };
    Blocked why;
    why.part = parts.front();
    try {
      Plan plan = plan_path(removal_scene(scene_, there, parts), options);
      if (plan.found) {
        out_.order.push_back({parts, there, std::move(plan)});
        there.erase(std::remove_if(there.begin(), there.end(), [&](std::size_t p) { return has(parts, p); }),
                    there.end());
        return true;
      }
      Parts others;
      std::copy_if(there.begin(), there.end(), std::back_inserter(others),
                   [&](std::size_t p) { return !has(parts, p); });
      for (const PartInTheWay& p : plan.in_the_way) why.by.push_back(others[p.part]);
    } catch (const Error& e) {
      why.error = e.what();  // told with the result: one part that overlaps another leaves the rest to be taken apart
    }
    blocked_[parts] = std::move(why);
    return false;
  }

  bool take_single(Parts& there, std::int64_t iterations) {
    for (const std::size_t part : Parts(there))
      if (!stopped() && try_out(there, {part}, iterations)) return true;
    return false;
  }

  /// The group with one more part, in order.
  static Parts with(Parts group, std::size_t part) {
    group.insert(std::upper_bound(group.begin(), group.end(), part), part);
    return group;
  }

  /// A part together with one that stops it; where no two come out, with what stops both, and so on.
  bool take_group(Parts& there) {
    std::set<Parts> tried;
    std::vector<Parts> stopped_groups;
    for (const std::size_t part : there) stopped_groups.push_back({part});
    // All that is there but one comes out as that one does.
    for (std::size_t size = 2; size <= kMaxGroup && size < there.size(); ++size) {
      std::vector<Parts> larger;
      for (const Parts& group : stopped_groups) {
        Parts by = blocked_[group].by;
        // More partners than one are for a part alone: a group that grew by the wrong one has others beside it.
        const std::size_t partners = size == 2 ? kPartners : 1;
        if (by.size() > partners) by.resize(partners);
        for (const std::size_t partner : by) {
          const Parts grown = with(group, partner);
          if (stopped() || !has(there, partner) || !tried.insert(grown).second) continue;
          if (take_out(there, grown)) return true;
          larger.push_back(grown);
        }
      }
      stopped_groups = std::move(larger);
    }
    return false;
  }

  /// Whether a group comes out; what does not come apart of it stays together.
  bool take_out(Parts& there, const Parts& group) {
    if (!try_out(there, group, options_.iterations)) return false;
    const Parts rest = take(group);
    if (rest.size() > 1) out_.together.push_back(rest);
    return true;
  }

  const Scene& scene_;
  const DisassemblyOptions& options_;
  Disassembly out_;
  std::map<Parts, Blocked> blocked_;  // by what was tried
};

}  // namespace

Scene removal_scene(const Scene& scene, const Parts& there, const Parts& parts) {
  Scene out = scene;
  out.parts.clear();
  for (const std::size_t p : there) {
    if (has(parts, p)) continue;
    out.parts.push_back(scene.parts[p]);
    out.parts.back().held = false;
  }
  Part held = scene.parts[parts.front()];
  held.held = true;
  if (parts.size() > 1) {
    auto mesh = std::make_shared<TriangleMesh>();
    held.name.clear();
    for (const std::size_t p : parts) {
      const Part& part = scene.parts[p];
      held.name += (held.name.empty() ? "" : " + ") + part.name;
      const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
      for (const Vec3& v : part.mesh->vertices) mesh->vertices.push_back(part.pose * v);
      for (const auto& t : part.mesh->triangles) mesh->triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
    mesh->name = held.name;
    held.mesh = std::move(mesh);
    held.pose = {};
  }
  out.parts.push_back(std::move(held));
  return out;
}

Disassembly take_apart(const Scene& scene, const DisassemblyOptions& options) {
  if (!has_planner()) throw Error(missing_planner());
  if (scene.parts.size() < 2) throw Error("an assembly of one part is apart");
  Taking taking(scene, options);
  taking.take_all();
  return taking.result();
}

}  // namespace tegotae
