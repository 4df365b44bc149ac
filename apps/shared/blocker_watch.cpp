#include "shared/blocker_watch.hpp"

#include <array>
#include <map>

namespace tegotae::apps {
namespace {

constexpr double kLooksBack = 0.5;        // s
constexpr std::size_t kTouches = 2048;    // four parts in each tick of that time
constexpr std::size_t kPartsInATick = 8;  // at the same time in contact; of more, the first

struct Sum {
  PartId part;
  Vec3 places;
  int count;
};

}  // namespace

BlockerWatch::BlockerWatch() : touches_(kTouches) {}

void BlockerWatch::add(const Touch& touch) noexcept {
  if (count_ == touches_.size()) {
    first_ = (first_ + 1) % touches_.size();
    --count_;
  }
  touches_[(first_ + count_) % touches_.size()] = touch;
  ++count_;
}

void BlockerWatch::after_tick(const TickView& tick) noexcept {
  const HapticLoop& loop = tick.loop;
  const TickReport& report = loop.report();
  end_ = tick.t;
  if (report.contacts == 0) return;
  const Vec3 center = report.proxy.X * loop.center();
  std::array<Sum, kPartsInATick> sums;
  std::size_t n = 0;
  for (const Contact& c : loop.constraints()) {
    if (c.age == kOneShotAge || c.gap > report.contact_gap) continue;
    std::size_t i = 0;
    while (i < n && !(sums[i].part == c.part)) ++i;
    if (i == sums.size()) continue;
    if (i == n) sums[n++] = {c.part, Vec3::Zero(), 0};
    sums[i].places += center + c.r;
    ++sums[i].count;
  }
  for (std::size_t i = 0; i < n; ++i) add({tick.t, sums[i].part, sums[i].places / sums[i].count});
}

Blocker BlockerWatch::find(const Scene& scene) const {
  std::map<PartId, std::size_t> counts;
  std::map<PartId, Vec3> last;
  for (std::size_t i = 0; i < count_; ++i) {
    const Touch& one = touch(i);
    if (one.t < end_ - kLooksBack) continue;
    ++counts[one.part];
    last[one.part] = one.place_W;
  }
  Blocker out;
  std::size_t most = 0;
  for (const auto& [part, count] : counts) {
    if (count <= most) continue;
    most = count;
    out = {scene.parts[part.index].name, last[part]};
  }
  return out;
}

}  // namespace tegotae::apps
