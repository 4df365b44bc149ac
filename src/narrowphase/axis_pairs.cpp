#include "narrowphase/axis_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "core/parallel_for.hpp"
#include "curve/axis_search.hpp"
#include "mesh/in_use.hpp"
#include "narrowphase/axis_cache.hpp"

namespace tegotae {
namespace {

/// Rises that differ by less than this part are one: threads that mate have the same.
constexpr double kSameRise = 0.05;

using Axes = std::vector<ScrewAxis>;

/// A value that lives as long as it is used, made for a hierarchy that it keeps alive.
template <typename T>
struct Kept {
  std::shared_ptr<const PatchTree> tree;
  T value;
};

template <typename T, typename Key, typename Make>
std::shared_ptr<const T> kept(InUse<Key, Kept<T>>& in_use, const Key& key, const std::shared_ptr<const PatchTree>& tree,
                              const Make& make) {
  const auto found = in_use.get(key, [&] { return std::make_shared<const Kept<T>>(Kept<T>{tree, make()}); });
  return std::shared_ptr<const T>(found, &found->value);
}

std::shared_ptr<const Axes> axes_of(const std::shared_ptr<const PatchTree>& tree) {
  static InUse<const PatchTree*, Kept<Axes>> in_use;
  return kept<Axes, const PatchTree*>(in_use, tree.get(), tree, [&] { return cached_axes(tree->mesh()); });
}

std::shared_ptr<const ProfileTree> profile_about(const std::shared_ptr<const PatchTree>& tree, const ScrewAxis& axis,
                                                 double rise) {
  using Key = std::tuple<const PatchTree*, double, double, double, double, double, double, double>;
  static InUse<Key, Kept<ProfileTree>> in_use;
  const Vec3 &o = axis.origin, &d = axis.direction;
  const Key key{tree.get(), rise, o.x(), o.y(), o.z(), d.x(), d.y(), d.z()};
  return kept<ProfileTree, Key>(in_use, key, tree, [&] { return cached_profile(*tree, ScrewFrame::of(axis, rise)); });
}

/// Two profiles of so many triangles take longer to build than a thread takes to begin.
constexpr std::size_t kWorthThreads = 10000;

bool worth_threads(const PatchTree& a, const PatchTree& b) {
  return std::min(a.order().size(), b.order().size()) >= kWorthThreads;
}

bool mate(const ScrewAxis& a, const ScrewAxis& b) {
  return std::abs(a.rise - b.rise) <= kSameRise * std::min(std::abs(a.rise), std::abs(b.rise));
}

}  // namespace

struct AxisPairing::Known {
  std::shared_ptr<const PatchTree> held;
  std::shared_ptr<const Axes> axes;
  struct Fixed {
    std::shared_ptr<const Axes> axes;
    std::vector<AxisPair> pairs;
  };
  std::map<const PatchTree*, Fixed> fixed;
};

AxisPairing::AxisPairing(std::shared_ptr<const PatchTree> held) : known_(std::make_unique<Known>()) {
  known_->axes = axes_of(held);
  known_->held = std::move(held);
}

AxisPairing::~AxisPairing() = default;

const std::vector<AxisPair>* AxisPairing::with(const std::shared_ptr<const PatchTree>& b) {
  const auto [place, added] = known_->fixed.try_emplace(b.get());
  Known::Fixed& fixed = place->second;
  if (!added || known_->axes->empty()) return &fixed.pairs;
  fixed.axes = axes_of(b);
  struct Candidate {
    const ScrewAxis *a, *b;
  };
  std::vector<Candidate> candidates;
  for (const ScrewAxis& x : *known_->axes)
    for (const ScrewAxis& y : *fixed.axes)
      if (mate(x, y)) candidates.push_back({&x, &y});
  std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& p, const Candidate& q) {
    return std::min(p.a->area, p.b->area) > std::min(q.a->area, q.b->area);
  });
  for (const Candidate& c : candidates) {
    if (fixed.pairs.size() == kMaxAxisPairs) break;
    AxisPair pair;
    const auto make = [&](int side) {
      if (side == 0)
        pair.a = profile_about(known_->held, *c.a, c.b->rise);
      else
        pair.b = profile_about(b, *c.b, c.b->rise);
    };
    parallel_for(2, worth_threads(*known_->held, *b) ? 2 : 1, make, {});
    if (pair.a->boxes() > 0 && pair.b->boxes() > 0) fixed.pairs.push_back(std::move(pair));
  }
  return &fixed.pairs;
}

}  // namespace tegotae
