#include "loop/initial_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "core/number_text.hpp"
#include "loop/inward_offset.hpp"
#include "loop/scene_parts.hpp"
#include "narrowphase/patch_cache.hpp"
#include "narrowphase/patch_front.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

// Beyond kGapFloor (m): the certificate's fast checks are rounded by 0.05 um in a part of 100 mm, and pairs without
// that to spare are searched one by one, all of a seat in every tick.
constexpr double kSpare = 2e-7;
// Of a gap below kGapFloor, what motions must leave.
constexpr double kMarginShare = 0.5;
// The deepest point that was found may not be the deepest: the copy is made smaller by this much more until it is free,
// up to so many tolerances.
constexpr double kMore = 1.25, kMaxTolerances = 2;

std::string length(double m) {
  return m < 1e-3 ? number_text(1e6 * m, 3) + " um" : number_text(1e3 * m, 4) + " mm";
}

/// What a pair has of kGapFloor that must not be lost: its gap in part, its depth in full.
double kept(const Clash& c) {
  return c.gap > 0 ? kMarginShare * c.gap : -c.depth.value_or(0);
}

bool free_at_start(const PatchTree& a, const Vec3& center, const PatchTree& b, const Pose& X_BA) {
  PatchFront front;
  front.attach(a, center, b);
  front.set_clearance(kGapFloor);
  WorkLimit limit;
  limit.searches = 1 << 20;
  return front.certify(X_BA, Displacement{}, limit).status == CertifyStatus::certified;
}

}  // namespace

InitialContacts::InitialContacts(const Scene& scene, const ContactSettings& settings)
    : ignore_(settings.initial_overlap == InitialOverlap::ignore), tolerance_(settings.touch_tolerance) {
  std::uint32_t fixed = 0;
  for (const Part& p : scene.parts) number_.push_back(p.held ? kNobody : fixed++);
  ClashOptions options;
  options.tolerance = settings.touch_tolerance;
  options.held_only = true;
  for (const Clash& c : find_clashes(scene, options)) {
    InitialContact pair;
    pair.part = scene.parts[c.a].held ? c.b : c.a;
    pair.clash = c;
    if (c.kind == ClashKind::overlap) filter_or_refuse(scene, pair, "");
    report_.pairs.push_back(pair);
    if (pair.state == InitialContactState::filtered) waiting_.back().pair = report_.pairs.size() - 1;
  }
  count_ = waiting_.size();
}

void InitialContacts::filter_or_refuse(const Scene& scene, InitialContact& pair, const std::string& why) {
  const Part& other = scene.parts[pair.part];
  const Part& held = held_part(scene);
  const Clash& c = pair.clash;
  if (!ignore_) {
    const Vec3& p = c.place_W;
    const std::string place =
        "(" + number_text(p.x(), 6) + ", " + number_text(p.y(), 6) + ", " + number_text(p.z(), 6) + ") m";
    throw Error(ErrorKind::overlap,
                "parts \"" + held.name + "\" and \"" + other.name + "\" intersect at the start, " +
                    (c.triangle_pairs == 0 ? "one inside the other, " : "") +
                    (c.depth ? length(*c.depth) + " deep" : "open surfaces") + " at " + place + " (" +
                    std::to_string(c.triangle_pairs) + " intersecting triangle pairs" + why +
                    "); move the held part to a free position, set contact.touch_tolerance (now " + length(tolerance_) +
                    ") higher, or set contact.initial_overlap = \"ignore\" to suspend the pair until it has come free",
                {{}, 0, {}, other.name});
  }
  pair.state = InitialContactState::filtered;
  pair.freed = InitialContact::kNotYet;
  Waiting w;
  w.part = number_[pair.part];
  w.inside = std::make_unique<ContainmentTest>(held.mesh, other.mesh);
  w.X_WB = other.pose;
  waiting_.push_back(std::move(w));
  ++filtered_;
}

std::vector<InitialContacts::Copy> InitialContacts::shrink(const Scene& scene, const Vec3& center,
                                                           std::uint32_t first) {
  std::vector<Copy> copies;
  const Part& held = held_part(scene);
  for (std::size_t i = 0; i < report_.pairs.size(); ++i) {
    InitialContact& pair = report_.pairs[i];
    const Clash& c = pair.clash;
    if (pair.state == InitialContactState::filtered || c.gap >= kGapFloor + kSpare) continue;
    const Part& other = scene.parts[pair.part];
    const auto surface = cached_surface(other.mesh);
    const Pose X_BA = other.pose.inverse() * held.pose;
    const auto held_tree = cached_patch_tree(held.mesh);
    Copy copy{number_[pair.part], nullptr, nullptr};
    bool found = false;
    for (double by = kGapFloor + kSpare - kept(c); !found && by < kGapFloor + kSpare + kMaxTolerances * tolerance_;
         by *= kMore) {
      copy.mesh = std::make_shared<TriangleMesh>(inward_offset(*surface, by));
      copy.tree = cached_patch_tree(copy.mesh);
      found = tegotae::free_at_start(*held_tree, center, *copy.tree, X_BA);
      pair.inward_offset = by;
    }
    if (!found) {
      pair.inward_offset = 0;
      filter_or_refuse(scene, pair, ", and a smaller copy of the fixed part does not free them");
      waiting_.back().pair = i;
      continue;
    }
    pair.state = InitialContactState::shrunk;
    pair.freed = InitialContact::kNotYet;
    Waiting w;
    w.pair = i;
    w.part = copy.part;
    w.stand_in = first + static_cast<std::uint32_t>(copies.size());
    w.X_WB = other.pose;
    waiting_.push_back(std::move(w));
    copies.push_back(std::move(copy));
  }
  count_ = waiting_.size();
  return copies;
}

void InitialContacts::apply(std::vector<std::uint32_t>& near) const noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    const auto at = std::find(near.begin(), near.end(), waiting_[i].part);
    if (at == near.end()) continue;
    if (waiting_[i].stand_in == kNobody)
      near.erase(at);
    else
      *at = waiting_[i].stand_in;
  }
}

const InitialContacts::Waiting* InitialContacts::poll(const Pose& X, MotionCheck& check,
                                                      std::int64_t deadline_ns) noexcept {
  if (X.p != last_.p || X.q.coeffs() != last_.q.coeffs()) {
    last_ = X;
    polled_ = 0;
  }
  if (polled_ >= count_) return nullptr;
  next_ = next_ + 1 < count_ ? next_ + 1 : 0;
  const Waiting& w = waiting_[next_];
  const MotionAnswer answer = check.stands(X, w.part, kGapFloor, deadline_ns);
  // What time ran out for is asked again, also while the part stands still.
  if (answer != MotionAnswer::unknown) ++polled_;
  if (answer != MotionAnswer::free || (w.inside && w.inside->inside(w.X_WB.inverse() * X))) return nullptr;
  report_.pairs[waiting_[next_].pair].freed = ++freed_;
  retire(next_);
  return &waiting_[count_];
}

void InitialContacts::retire(std::size_t i) noexcept {
  report_.pairs[waiting_[i].pair].state = InitialContactState::active;
  filtered_ -= waiting_[i].stand_in == kNobody ? 1 : 0;
  --count_;
  std::swap(waiting_[i], waiting_[count_]);
}

void InitialContacts::free_at_start(std::size_t i) {
  report_.pairs[waiting_[i].pair].freed = 0;
  retire(i);
}

}  // namespace tegotae
