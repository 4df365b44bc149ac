#include "contact/contact_set.hpp"

#include <algorithm>
#include <map>

#include "core/same_pose.hpp"
#include "narrowphase/patch_cache.hpp"
#include "tegotae/core/clock.hpp"

namespace tegotae {
namespace {

// Pairs followed between two looks at the clock (about 1 µs each).
constexpr std::size_t kClockStride = 8;

std::vector<NearestFace> nearest_faces(const std::vector<FixedSurface>& fixed) {
  std::vector<NearestFace> out;
  std::map<const Surface*, std::size_t> first;
  for (const FixedSurface& f : fixed) {
    const auto [known, fresh] = first.emplace(f.surface.get(), out.size());
    if (fresh)
      out.emplace_back(f.surface, cached_patch_tree(f.surface->mesh));
    else
      out.push_back(NearestFace(out[known->second]));
  }
  return out;
}

}  // namespace

ContactSet::ContactSet(std::shared_ptr<const Surface> held, std::vector<FixedSurface> fixed, const Vec3& center,
                       int capacity, std::size_t max_followed)
    : held_(std::move(held)),
      fixed_(std::move(fixed)),
      near_held_(held_, cached_patch_tree(held_->mesh)),
      near_fixed_(nearest_faces(fixed_)),
      center_(center),
      capacity_(capacity),
      max_followed_(std::min(max_followed, static_cast<std::size_t>(capacity))),
      choice_(static_cast<std::size_t>(capacity)),
      center_W_(center),
      relative_(fixed_.size(), Relative{Pose{}, 0}) {
  const auto size = static_cast<std::size_t>(capacity);
  pairs_.reserve(size);
  next_.reserve(size);
  constraints_.reserve(size);
  next_constraints_.reserve(size);
  cut_.reserve(size);
  owners_.reserve(size);
  next_owners_.reserve(size);
  taken_.reserve(size);
  must_.reserve(size);
  std::size_t places = 16;
  while (places < 4 * size) places *= 2;
  table_.assign(places, -1);
}

std::size_t ContactSet::slot(std::uint32_t part, Feature a, Feature b) const {
  std::uint64_t h =
      (number(a) * 0x9e3779b97f4a7c15ull) ^ (number(b) * 0xc2b2ae3d27d4eb4full) ^ (part * 0x165667b19e3779f9ull);
  h ^= h >> 29;
  std::size_t i = h & (table_.size() - 1);
  while (table_[i] >= 0) {
    const Pair& p = next_[static_cast<std::size_t>(table_[i])];
    if (p.part == part && p.a == a && p.b == b) break;
    i = (i + 1) & (table_.size() - 1);
  }
  return i;
}

bool ContactSet::known(std::uint32_t part, Feature a, Feature b) const {
  return table_[slot(part, a, b)] >= 0;
}

void ContactSet::remember(const Pair& pair) {
  const std::size_t place = slot(pair.part, pair.a, pair.b);
  table_[place] = static_cast<std::int32_t>(next_.size());
  taken_.push_back(place);
  next_.push_back(pair);
}

void ContactSet::forget_places() {
  for (const std::size_t place : taken_) table_[place] = -1;
  taken_.clear();
}

void ContactSet::begin_track(const Pose& X, double reach) {
  X_ = X;
  center_W_ = X_ * center_;
  ++poses_;
  asked_.forget();
  reach_ = reach;
  followed_ = 0;
  overflow_ = 0;
  tried_count_ = 0;
  forget_places();
  next_.clear();
  next_constraints_.clear();
  next_owners_.clear();
  cut_.clear();
}

void ContactSet::clear() {
  begin_track(X_, 0);
  pairs_.clear();
  constraints_.clear();
  owners_.clear();
}

void ContactSet::transfer(std::uint32_t from, std::uint32_t to) noexcept {
  for (Pair& pair : pairs_)
    if (pair.part == from) pair.part = to;
  followed_ = 0;
}

void ContactSet::carries(std::size_t constraint) noexcept {
  const std::uint32_t pair = owners_[constraint];
  if (pair != kNone) next_[pair].carries = pairs_[pair].carries = true;
}

const Pose& ContactSet::pose_in(std::uint32_t part) const {
  Relative& known = relative_[part];
  if (known.at != poses_) known = {fixed_[part].X_WB.inverse() * X_, poses_};
  return known.X_BA;
}

FeaturePair ContactSet::follow(const Pair& pair) const {
  const Surface& B = *fixed_[pair.part].surface;
  const Pose& X_BA = pose_in(pair.part);
  const FeaturePair at = walk_to_minimum(*held_, B, X_BA, pair.a, pair.b);
  if (at.ended || pair.a.kind != FeatureKind::vertex || at.b.kind == FeatureKind::vertex) return at;
  // Too many small faces on the way (the middle of a fan): the hierarchy knows where the corner is now.
  const std::uint32_t face = at.b.kind == FeatureKind::face ? at.b.index : B.topology.edges[at.b.index].f[0];
  const Vec3 p = X_BA * held_->mesh->vertices[pair.a.index];
  NearFace best;
  best.squared = reach_ * reach_;
  near_fixed_[pair.part].find_in_region(p, face, best);
  if (best.face == kNone) return at;
  return walk_to_minimum(*held_, B, X_BA, pair.a, subfeature(B, {FeatureKind::face, best.face}, best.mask));
}

bool ContactSet::track(const Pose& X, double reach, std::int64_t deadline_ns) {
  const bool goes_on = followed_ > 0 && same_pose(X, X_) && reach == reach_;
  if (!goes_on) begin_track(X, reach);
  // Pairs in support come last: the others that may speak for them are known by then.
  for (; followed_ < 2 * pairs_.size(); ++followed_) {
    const Pair& old = pairs_[followed_ % pairs_.size()];
    if (old.support != (followed_ >= pairs_.size())) continue;
    if (followed_ % kClockStride == kClockStride - 1 && past(deadline_ns)) return false;
    const FeaturePair at = follow(old);
    if (at.distance > reach_ || known(old.part, at.a, at.b)) continue;
    const bool support = redundant(old.part, at.a, at.b);
    if (support &&
        (!old.support || spoken_for(constraint_of(old.part, at, 0), old.part, next_constraints_, next_owners_)))
      continue;
    remember({old.part, at.a, at.b, old.age + 1, support, old.carries});
    add_constraints(static_cast<std::uint32_t>(next_.size() - 1), at, next_constraints_, next_owners_);
  }
  followed_ = 0;
  if (next_.size() > max_followed_) choose();
  for (Pair& pair : next_) pair.carries = false;
  pairs_.assign(next_.begin(), next_.end());
  constraints_.swap(next_constraints_);
  owners_.swap(next_owners_);
  return true;
}

void ContactSet::choose() {
  must_.clear();
  for (const Pair& pair : next_) must_.push_back(pair.carries ? 1 : 0);
  overflow_ += static_cast<int>(next_.size() - max_followed_);
  choice_.choose(next_constraints_, next_owners_, next_.size(), max_followed_, must_);
  keep(choice_.kept());
}

void ContactSet::keep(const std::vector<std::uint8_t>& kept) {
  std::size_t constraints = 0;
  for (std::size_t i = 0; i < next_constraints_.size(); ++i) {
    if (kept[next_owners_[i]] == 0) continue;
    next_constraints_[constraints] = next_constraints_[i];
    next_owners_[constraints++] = next_owners_[i];
  }
  next_constraints_.erase(next_constraints_.begin() + static_cast<std::ptrdiff_t>(constraints),
                          next_constraints_.end());
  next_owners_.resize(constraints);
  forget_places();
  pairs_.clear();
  pairs_.swap(next_);
  std::size_t constraint = 0;
  for (std::uint32_t i = 0; i < pairs_.size(); ++i) {
    if (kept[i] == 0) continue;
    // Constraints are in the order of their pairs.
    for (; constraint < constraints && next_owners_[constraint] == i; ++constraint)
      next_owners_[constraint] = static_cast<std::uint32_t>(next_.size());
    remember(pairs_[i]);
  }
}

bool ContactSet::redundant(std::uint32_t part, Feature a, Feature b) const {
  const auto flat = [](const Surface& s, Feature f) {
    if (f.kind == FeatureKind::vertex) return s.topology.vertex_flat[f.index] != 0;
    return f.kind == FeatureKind::edge && s.topology.edges[f.index].kind == EdgeKind::flat;
  };
  // On the other side a flat feature stands for the plane it lies in and is needed.
  const Surface& B = *fixed_[part].surface;
  if (a.kind == FeatureKind::edge && b.kind == FeatureKind::edge) return flat(*held_, a) || flat(B, b);
  if (a.kind == FeatureKind::vertex && b.kind == FeatureKind::vertex) return flat(*held_, a) && flat(B, b);
  return a.kind == FeatureKind::vertex ? flat(*held_, a) : flat(B, b);
}

}  // namespace tegotae
