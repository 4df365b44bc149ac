#include "narrowphase/axis_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <tuple>

#include "core/parallel_for.hpp"
#include "curve/axis_search.hpp"

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

/// What is in use, by a key that begins with the hierarchy's address: as long as a value lives, so does its hierarchy,
/// and no other has that address.
template <typename Key, typename T>
class InUse {
 public:
  template <typename Make>
  std::shared_ptr<const T> get(const Key& key, const std::shared_ptr<const PatchTree>& tree, Make make) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      for (auto i = known_.begin(); i != known_.end();) i = i->second.expired() ? known_.erase(i) : std::next(i);
      const auto known = known_.find(key);
      if (known != known_.end())
        if (auto kept = known->second.lock()) return std::shared_ptr<const T>(kept, &kept->value);
    }
    const auto kept = std::make_shared<const Kept<T>>(Kept<T>{tree, make()});
    const std::lock_guard<std::mutex> lock(mutex_);
    known_[key] = kept;
    return std::shared_ptr<const T>(kept, &kept->value);
  }

 private:
  std::mutex mutex_;
  std::map<Key, std::weak_ptr<const Kept<T>>> known_;
};

std::shared_ptr<const Axes> axes_of(const std::shared_ptr<const PatchTree>& tree) {
  static InUse<const PatchTree*, Axes> in_use;
  return in_use.get(tree.get(), tree, [&] { return find_axes(tree->mesh()); });
}

std::shared_ptr<const ProfileTree> profile_about(const std::shared_ptr<const PatchTree>& tree, const ScrewAxis& axis,
                                                 double rise) {
  using Key = std::tuple<const PatchTree*, double, double, double, double, double, double, double>;
  static InUse<Key, ProfileTree> in_use;
  const Vec3 &o = axis.origin, &d = axis.direction;
  return in_use.get(Key{tree.get(), rise, o.x(), o.y(), o.z(), d.x(), d.y(), d.z()}, tree,
                    [&] { return ProfileTree(*tree, ScrewFrame::of(axis, rise)); });
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
