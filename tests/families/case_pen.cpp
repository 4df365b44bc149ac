#include "families/case_pen.hpp"

#include <vector>

#include "families/family_tools.hpp"

namespace tegotae::test {
namespace {

constexpr int kApproach = 120, kLeg = 50, kJab = 15, kSettle = 60, kAway = 80;  // ticks
constexpr int kJabs = 3;

struct Plan {
  std::vector<StylusScript::Key> keys;
  std::vector<int> ends;
};

Plan plan(const FamilyCase& c, int rest_ticks) {
  Plan plan;
  int now = 0;
  const auto go = [&](int ticks, double along, const Vec3& aside, const Vec3& turned) {
    now += ticks;
    plan.keys.push_back(
        {1e-3 * now, {(rotation(turned) * c.seat.q).normalized(), c.seat.p + along * c.approach + aside}});
  };
  const auto end_phase = [&] { plan.ends.push_back(now); };
  const Vec3 none = Vec3::Zero(), about = c.turn * c.approach, across = c.tilt * c.approach.unitOrthogonal();
  go(0, -c.start, none, none);
  go(kApproach, c.press, none, none);
  end_phase();
  go(rest_ticks, c.press, none, none);
  end_phase();
  go(2 * kLeg, c.press, c.slide, none);
  go(2 * kLeg, c.press, none, none);
  end_phase();
  go(kLeg, c.press, none, about);
  go(kLeg, c.press, none, about + across);
  go(kLeg, c.press, none, -about);
  go(kLeg, c.press, none, none);
  end_phase();
  for (unsigned i = 0; i < kJabs; ++i) {
    const Vec3 aside = (draw(c.parameters, 50 + i) - 0.5) * c.slide;
    go(kJab, -c.start * draw(c.parameters, 60 + i), aside, none);
    go(kJab, c.press, aside, none);
  }
  end_phase();
  go(kSettle, c.press, none, none);
  end_phase();
  go(kApproach, -c.start, none, none);
  end_phase();
  go(kAway, -c.start, none, none);
  end_phase();
  return plan;
}

}  // namespace

CasePen::CasePen(const FamilyCase& c, int rest_ticks)
    : ends_(plan(c, rest_ticks).ends), script_(plan(c, rest_ticks).keys) {}

Phase CasePen::phase(int tick) const {
  std::size_t i = 0;
  while (i + 1 < ends_.size() && tick >= ends_[i]) ++i;
  return static_cast<Phase>(i);
}

}  // namespace tegotae::test
