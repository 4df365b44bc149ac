#include "plan/growing_paths.hpp"

#include <algorithm>

namespace tegotae {
namespace {

// What a tree is grown towards, at first: any pose of the room, the other tree, what led to a pose once more, else a
// shift, turn or screw of it.
constexpr double kAnywhere = 0.3, kOtherTree = 0.15, kRepeat = 0.15;
// A path that is known is worth as much as all others.
constexpr double kKnownPath = 1;
// The share of the past in what is known of a way, and the least that is thought of it.
constexpr double kPast = 0.9, kMinHope = 0.05, kFirstHope = 0.5;

}  // namespace

GrowingPaths::GrowingPaths(bool known)
    : ways_{{GrowingMotion::anywhere, 0, 1, kAnywhere, kFirstHope},
            {GrowingMotion::other_tree, 0, 1, kOtherTree, kFirstHope},
            {GrowingMotion::repeat, 0, 1, kRepeat, kFirstHope}} {
  std::vector<GrowingPath> own;
  for (const GrowingMotion motion : {GrowingMotion::shift, GrowingMotion::turn, GrowingMotion::screw})
    for (int axis = 0; axis <= 6; ++axis)
      for (const double sign : {1.0, -1.0}) own.push_back({motion, axis, sign, 0, kFirstHope});
  for (GrowingPath& way : own) way.share = (1 - kAnywhere - kOtherTree - kRepeat) / static_cast<double>(own.size());
  ways_.insert(ways_.end(), own.begin(), own.end());
  if (known) ways_.push_back({GrowingMotion::known_path, 0, 1, kKnownPath, kFirstHope});
}

GrowingPath& GrowingPaths::choose(double at) {
  double all = 0;
  for (const GrowingPath& way : ways_) all += way.share * way.hope;
  at *= all;
  for (GrowingPath& way : ways_) {
    at -= way.share * way.hope;
    if (at < 0) return way;
  }
  return ways_.back();
}

void GrowingPaths::report(GrowingPath& way, bool led_on) {
  way.hope = std::max(kMinHope, kPast * way.hope + (1 - kPast) * (led_on ? 1 : 0));
}

}  // namespace tegotae
