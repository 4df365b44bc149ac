#include "contact/contact_set.hpp"

#include <algorithm>

#include "contact/separating_axis.hpp"
#include "feature/simplex_distance.hpp"
#include "tegotae/core/clock.hpp"

namespace tegotae {
namespace {

// Pairs followed between two looks at the clock (about 1 µs each).
constexpr std::size_t kClockStride = 8;

}  // namespace

ContactSet::ContactSet(std::shared_ptr<const Surface> held, std::vector<FixedSurface> fixed, const Vec3& center,
                       int capacity)
    : held_(std::move(held)), fixed_(std::move(fixed)), center_(center), capacity_(capacity) {
  pairs_.reserve(capacity);
  next_.reserve(capacity);
  limits_.reserve(capacity);
  next_limits_.reserve(capacity);
  taken_.reserve(capacity);
  std::size_t size = 16;
  while (size < 4 * static_cast<std::size_t>(capacity)) size *= 2;
  table_.assign(size, -1);
}

std::size_t ContactSet::slot(std::uint32_t part, Feature a, Feature b) const {
  const auto key = [](Feature f) { return std::uint64_t{f.index} * 3 + static_cast<std::uint64_t>(f.kind); };
  std::uint64_t h =
      (key(a) * 0x9e3779b97f4a7c15ull) ^ (key(b) * 0xc2b2ae3d27d4eb4full) ^ (part * 0x165667b19e3779f9ull);
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

void ContactSet::begin_track(const Pose& X, double reach) {
  X_ = X;
  reach_ = reach;
  followed_ = 0;
  overflow_ = 0;
  next_.clear();
  next_limits_.clear();
  for (const std::size_t place : taken_) table_[place] = -1;
  taken_.clear();
}

void ContactSet::clear() {
  begin_track(X_, 0);
  pairs_.clear();
  limits_.clear();
}

void ContactSet::transfer(std::uint32_t from, std::uint32_t to) noexcept {
  for (Pair& pair : pairs_)
    if (pair.part == from) pair.part = to;
  followed_ = 0;
}

bool ContactSet::track(const Pose& X, double reach, std::int64_t deadline_ns) {
  const bool goes_on = followed_ > 0 && X.p == X_.p && X.q.coeffs() == X_.q.coeffs() && reach == reach_;
  if (!goes_on) begin_track(X, reach);
  for (; followed_ < pairs_.size(); ++followed_) {
    if (followed_ % kClockStride == kClockStride - 1 && past(deadline_ns)) return false;
    const Pair& old = pairs_[followed_];
    const FixedSurface& B = fixed_[old.part];
    const FeaturePair at = walk_to_minimum(*held_, *B.surface, B.X_WB.inverse() * X, old.a, old.b);
    if (at.distance > reach || redundant(old.part, at.a, at.b) || known(old.part, at.a, at.b)) continue;
    const Pair pair{old.part, at.a, at.b, old.age + 1};
    remember(pair);
    add_limits(pair, at, next_limits_);
  }
  followed_ = 0;
  pairs_.assign(next_.begin(), next_.end());
  limits_.swap(next_limits_);
  return true;
}

int ContactSet::seed(const std::vector<FacePair>& triangles, const Pose& X_near, std::int64_t deadline_ns) {
  int fresh = 0;
  for (const FacePair& t : triangles) {
    if (past(deadline_ns)) break;
    if (static_cast<int>(next_.size()) >= capacity_) {
      ++overflow_;
      break;
    }
    const FixedSurface& B = fixed_[t.part];
    // A collapsed face has no features of its own; its corners and edges are those of the faces around.
    if (held_->topology.face_edges[t.a][0] == kNone || B.surface->topology.face_edges[t.b][0] == kNone) continue;
    const Feature fa{FeatureKind::face, t.a}, fb{FeatureKind::face, t.b};
    const Pose X_BW = B.X_WB.inverse(), near_BA = X_BW * X_near;
    Simplex sa = corners(*held_, fa);
    for (Vec3& p : sa.p) p = near_BA * p;
    const ClosestPoints c = closest_points(sa, corners(*B.surface, fb));
    const FeaturePair at = walk_to_minimum(*held_, *B.surface, X_BW * X_, subfeature(*held_, fa, c.mask_a),
                                           subfeature(*B.surface, fb, c.mask_b));
    if (at.distance > reach_ || redundant(t.part, at.a, at.b) || known(t.part, at.a, at.b)) continue;
    const Pair pair{t.part, at.a, at.b, 0};
    remember(pair);
    add_limits(pair, at, limits_);
    ++fresh;
  }
  if (fresh > 0) pairs_.assign(next_.begin(), next_.end());
  return fresh;
}

int ContactSet::cut(const std::vector<FacePair>& triangles, const Displacement& d, double clearance,
                    std::int64_t deadline_ns) {
  int added = 0;
  const Vec3 c = X_ * center_;
  for (const FacePair& t : triangles) {
    if (past(deadline_ns)) break;
    const FixedSurface& B = fixed_[t.part];
    std::array<Vec3, 3> a, b, motion;
    for (int k = 0; k < 3; ++k) {
      a[k] = X_ * held_->mesh->vertices[held_->mesh->triangles[t.a][k]];
      b[k] = B.X_WB * B.surface->mesh->vertices[B.surface->mesh->triangles[t.b][k]];
      motion[k] = d.dp + d.dr.cross(a[k] - c);
    }
    const AxisLimit axis = least_limiting_axis(a, b, motion, clearance);
    if (!axis.found) continue;
    add({axis.n, a[axis.corner] - c, axis.gap, t.part, kCutAge}, limits_);
    ++added;
  }
  return added;
}

Vec3 ContactSet::normal_B(std::uint32_t part, const FeaturePair& at) const {
  const FixedSurface& B = fixed_[part];
  const Topology& ta = held_->topology;
  const Topology& tb = B.surface->topology;
  const Vec3 apart = at.p_a - at.p_b;
  // A face's own normal is exact however small the gap; it is turned to the side on which A is (sheets have two).
  const auto towards_a = [&apart](const Vec3& n) { return Vec3(n.dot(apart) < 0 ? Vec3(-n) : n); };
  if (at.b.kind == FeatureKind::face && !tb.face_normals[at.b.index].isZero())
    return towards_a(tb.face_normals[at.b.index]);
  const Quat q_BA = B.X_WB.q.conjugate() * X_.q;
  if (at.a.kind == FeatureKind::face && !ta.face_normals[at.a.index].isZero())
    return towards_a(-(q_BA * ta.face_normals[at.a.index]));
  if (at.distance > 0) return apart / at.distance;
  // Touching features of no face: B's outward side, from the faces around its feature.
  Vec3 out = Vec3::Zero();
  if (at.b.kind == FeatureKind::vertex) {
    for (std::uint32_t k = tb.vertex_face_begin[at.b.index]; k < tb.vertex_face_begin[at.b.index + 1]; ++k)
      out += tb.face_normals[tb.vertex_faces[k]];
  } else if (at.b.kind == FeatureKind::edge) {
    for (const std::uint32_t f : tb.edges[at.b.index].f)
      if (f != kNone) out += tb.face_normals[f];
  }
  return out.squaredNorm() > 0 ? Vec3(out.normalized()) : Vec3::UnitZ();
}

void ContactSet::add_limits(const Pair& pair, const FeaturePair& at, std::vector<Contact>& limits) {
  const Pose& X_WB = fixed_[pair.part].X_WB;
  add({X_WB.q * normal_B(pair.part, at), X_WB * at.p_a - X_ * center_, at.distance, pair.part, pair.age}, limits);
  add_reflex_limits(pair, at, limits);
}

void ContactSet::add_reflex_limits(const Pair& pair, const FeaturePair& at, std::vector<Contact>& limits) {
  // A corner that hovers over one side of a concave edge is limited by the face on the other side too, although its
  // projection on that face lies just outside: without that limit it slides along its face into the other one.
  const bool corner_of_a = at.a.kind == FeatureKind::vertex && at.b.kind == FeatureKind::face;
  const bool corner_of_b = at.b.kind == FeatureKind::vertex && at.a.kind == FeatureKind::face;
  if (!corner_of_a && !corner_of_b) return;
  const FixedSurface& B = fixed_[pair.part];
  const Surface& s = corner_of_a ? *B.surface : *held_;
  const std::uint32_t face = corner_of_a ? at.b.index : at.a.index;
  const Pose X_BA = B.X_WB.inverse() * X_;
  const Vec3 corner = corner_of_a ? at.p_a : X_BA.inverse() * at.p_b;  // in the frame of `s`
  for (const std::uint32_t e : s.topology.face_edges[face]) {
    const Topology::Edge& edge = s.topology.edges[e];
    if (edge.kind != EdgeKind::concave) continue;
    const std::uint32_t other = edge.f[0] == face ? edge.f[1] : edge.f[0];
    const Vec3& n = s.topology.face_normals[other];
    const double height = n.dot(corner - s.mesh->vertices[edge.v[0]]);
    if (n.isZero() || height < 0 || height > reach_) continue;
    const auto& t = s.mesh->triangles[other];
    const Vec3 foot = corner - height * n;
    const ClosestPoints c =
        closest_points({1, {foot}}, {3, {s.mesh->vertices[t[0]], s.mesh->vertices[t[1]], s.mesh->vertices[t[2]]}});
    // Only across that very edge: past another one the plane of the face may run through free space.
    const auto& edges = s.topology.face_edges[other];
    const auto k = static_cast<unsigned>(std::find(edges.begin(), edges.end(), e) - edges.begin());
    const unsigned shared_edge = (1u << k) | (1u << (k + 1) % 3);
    if (c.squared_distance > reach_ * reach_ || (c.mask_b != 7 && c.mask_b != shared_edge)) continue;
    const Vec3 n_W = corner_of_a ? Vec3(B.X_WB.q * n) : Vec3(-(X_.q * n));
    const Vec3 on_a_W = corner_of_a ? Vec3(B.X_WB * corner) : Vec3(X_ * foot);
    add({n_W, on_a_W - X_ * center_, height, pair.part, pair.age}, limits);
  }
}

void ContactSet::add(const Contact& contact, std::vector<Contact>& limits) {
  if (static_cast<int>(limits.size()) >= capacity_) {
    ++overflow_;
    return;
  }
  limits.push_back(contact);
  const std::uint32_t named = fixed_[contact.part].stands_for;
  if (named != kNone) limits.back().part = named;
}

}  // namespace tegotae
