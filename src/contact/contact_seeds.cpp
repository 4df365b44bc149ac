// Where contacts come from: the triangle pairs that were in the way of a motion.
#include <algorithm>
#include <array>
#include <cmath>

#include "contact/contact_set.hpp"
#include "feature/simplex_distance.hpp"
#include "tegotae/core/clock.hpp"

namespace tegotae {
namespace {

// Fresh pairs after which a call ends: the next trial asks again, and each pair is to be followed before it.
constexpr int kMaxFresh = 64;
// Normals of contacts that speak for each other differ by less (as a cosine: 0.02 rad). So does the slope of the gap
// between them; gaps closer than the last (m) are the same.
constexpr double kSameNormal = 0.9998, kSlope = 0.02, kSameGap = 1e-6;
// Flat regions that lie on each other are parallel up to this (as a cosine: 0.03 rad, as far as walks go along).
constexpr double kParallel = 0.99955;
// What is nearer by less than this share of a squared distance is as near: rounding of boxes is a tenth of it.
constexpr double kSameDistance = 1 - 1e-4;
// Points that are nearer to a line through the middle than this share of their distance lie on it.
constexpr double kOnLine = 1e-6;

/// The corners of a flat region, or of a face that is one of its own, in order around it; file frame.
struct Outline {
  std::array<Vec3, kMaxRegionCorners> p;
  std::size_t size = 0;
};

/// Some of the faces around a feature: of a corner where very many meet, the first.
struct FacesAround {
  std::array<std::uint32_t, 16> faces;
  std::size_t size = 0;
};

FacesAround faces_around(const Surface& s, Feature f) {
  FacesAround out;
  const auto add = [&out](std::uint32_t face) {
    if (face != kNone && out.size < out.faces.size()) out.faces[out.size++] = face;
  };
  const Topology& t = s.topology;
  if (f.kind == FeatureKind::face) add(f.index);
  if (f.kind == FeatureKind::edge)
    for (const std::uint32_t face : t.edges[f.index].f) add(face);
  if (f.kind == FeatureKind::vertex)
    for (std::uint32_t k = t.vertex_face_begin[f.index]; k < t.vertex_face_begin[f.index + 1]; ++k)
      add(t.vertex_faces[k]);
  return out;
}

/// The flat region of a face, or the face where it is in none: they are numbered apart.
std::uint64_t region_or_face(const Surface& s, std::uint32_t face) {
  const std::uint32_t region = s.regions.of_face[face];
  return region == kNone ? 2 * std::uint64_t{face} : 2 * std::uint64_t{region} + 1;
}

/// False when there are fewer than two.
bool outline(const Surface& s, std::uint32_t face, Outline& out) {
  const auto add = [&](std::uint32_t v) { out.p[out.size++] = s.mesh->vertices[v]; };
  const FlatRegions& r = s.regions;
  if (const std::uint32_t region = r.of_face[face]; region == kNone)
    for (const std::uint32_t v : s.mesh->triangles[face]) add(v);
  else
    for (std::uint32_t i = r.corner_begin[region]; i < r.corner_begin[region + 1]; ++i) add(r.corners[i]);
  return out.size > 1;
}

/// Whether the middle (the origin) lies among points of a plane that are told one after the other: in their hull, or
/// between two of them. Keeps the narrowest cone that holds all.
class Surrounded {
 public:
  /// True once it does.
  bool add(double x, double y) {
    const double length = std::hypot(x, y);
    if (length < kSameGap) return true;
    const double p[2] = {x / length, y / length};
    if (!any_) {
      any_ = true;
      for (int i = 0; i < 2; ++i) right_[i] = left_[i] = p[i];
      return false;
    }
    const double of_right = cross(right_, p), of_left = cross(left_, p);
    if ((std::abs(of_right) < kOnLine && dot(right_, p) < 0) || (std::abs(of_left) < kOnLine && dot(left_, p) < 0))
      return true;
    if (of_right < 0 && of_left > 0) return true;
    if (of_right < 0) std::copy(p, p + 2, right_);
    if (of_left > 0) std::copy(p, p + 2, left_);
    return false;
  }

 private:
  static double cross(const double* a, const double* b) { return a[0] * b[1] - a[1] * b[0]; }
  static double dot(const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1]; }

  bool any_ = false;
  double right_[2] = {}, left_[2] = {};  ///< the two sides of the cone, less than half a turn apart
};

}  // namespace

int ContactSet::seed(const std::vector<FacePair>& triangles, const Pose& X_near, std::int64_t deadline_ns) {
  deadline_ns_ = deadline_ns;
  int fresh = 0;
  for (const FacePair& t : triangles) {
    if (out_of_time() || fresh >= kMaxFresh) break;
    if (static_cast<int>(next_.size()) >= capacity_) {
      ++overflow_;
      break;
    }
    // A collapsed face has no features of its own; its corners and edges are those of the faces around.
    if (held_->topology.face_edges[t.a][0] == kNone || fixed_[t.part].surface->topology.face_edges[t.b][0] == kNone)
      continue;
    const std::size_t tried = tried_count_;
    fresh += seed_pair(t, X_near);
    // What there was no time for is asked again in the next tick, which need not have moved the part.
    if (out_of_time()) tried_count_ = tried;
  }
  if (fresh > 0) pairs_.assign(next_.begin(), next_.end());
  return fresh;
}

void ContactSet::faces_within(double distance, std::size_t most, std::vector<FacePair>& faces) const noexcept {
  faces.clear();
  for (std::size_t i = 0; i < constraints_.size() && faces.size() < most; ++i) {
    if (owners_[i] == kNone || constraints_[i].gap > distance) continue;
    const Pair& pair = next_[owners_[i]];
    const FacesAround a = faces_around(*held_, pair.a), b = faces_around(*fixed_[pair.part].surface, pair.b);
    if (a.size > 0 && b.size > 0) faces.push_back({pair.part, a.faces[0], b.faces[0]});
  }
}

bool ContactSet::out_of_time() const {
  return past(deadline_ns_);
}

int ContactSet::seed_pair(const FacePair& t, const Pose& X_near) {
  const FixedSurface& B = fixed_[t.part];
  const Feature fa{FeatureKind::face, t.a}, fb{FeatureKind::face, t.b};
  const Pose near_BA = B.X_WB.inverse() * X_near;
  Simplex sa = corners(*held_, fa);
  for (Vec3& p : sa.p) p = near_BA * p;
  const ClosestPoints c = closest_points(sa, corners(*B.surface, fb));
  const FeaturePair at = walk_to_minimum(*held_, *B.surface, pose_in(t.part), subfeature(*held_, fa, c.mask_a),
                                         subfeature(*B.surface, fb, c.mask_b));
  int fresh = take(t.part, at, false);
  if (fresh > 0) fresh += seed_regions_at(t.part, at);
  if (try_first_time(t)) fresh += seed_regions(t) + seed_crossings(t);
  if (fresh == 0 && !out_of_time()) fresh = seed_corners(t) + seed_rims(t);
  return fresh > 0 ? fresh : take(t.part, at, true);
}

bool ContactSet::try_first_time(const FacePair& t) {
  const FlatRegions &ra = held_->regions, &rb = fixed_[t.part].surface->regions;
  if (ra.of_face[t.a] == kNone && rb.of_face[t.b] == kNone) return false;
  const TriedRegions pair{t.part, region_or_face(*held_, t.a), region_or_face(*fixed_[t.part].surface, t.b)};
  const auto end = tried_.begin() + static_cast<std::ptrdiff_t>(tried_count_);
  if (tried_count_ == tried_.size() || std::find(tried_.begin(), end, pair) != end) return false;
  tried_[tried_count_++] = pair;
  return true;
}

bool ContactSet::asked(Ask what, std::uint32_t part, std::uint64_t a, std::uint64_t b) noexcept {
  return asked_.again({4 * std::uint64_t{part} + static_cast<std::uint64_t>(what), a, b});
}

int ContactSet::seed_regions_at(std::uint32_t part, const FeaturePair& at) {
  // A corner touched first: of the regions that meet there it is the two that lie on each other that hold the part.
  const Surface& B = *fixed_[part].surface;
  const FacesAround a = faces_around(*held_, at.a), b = faces_around(B, at.b);
  const Mat3 R = pose_in(part).q.toRotationMatrix();
  int fresh = 0;
  for (std::size_t i = 0; i < a.size; ++i)
    for (std::size_t j = 0; j < b.size && !out_of_time(); ++j) {
      const FacePair t{part, a.faces[i], b.faces[j]};
      const double cosine = (R * held_->topology.face_normals[t.a]).dot(B.topology.face_normals[t.b]);
      if (std::abs(cosine) > kParallel && try_first_time(t)) fresh += seed_regions(t) + seed_crossings(t);
    }
  return fresh;
}

int ContactSet::seed_regions(const FacePair& t) {
  const FlatRegions &ra = held_->regions, &rb = fixed_[t.part].surface->regions;
  int fresh = 0;
  const std::uint32_t a = ra.of_face[t.a], b = rb.of_face[t.b];
  if (a != kNone)
    for (std::uint32_t i = ra.corner_begin[a]; i < ra.corner_begin[a + 1] && !out_of_time(); ++i)
      fresh += seed_corner_of_a(t, ra.corners[i]);
  if (b != kNone)
    for (std::uint32_t i = rb.corner_begin[b]; i < rb.corner_begin[b + 1] && !out_of_time(); ++i)
      fresh += seed_vertex_of_b(t.part, t.a, rb.corners[i]);
  return fresh;
}

int ContactSet::seed_corner_of_a(const FacePair& t, std::uint32_t vertex) {
  const Surface& B = *fixed_[t.part].surface;
  const NearestFace& around = near_fixed_[t.part];
  const Vec3 p = pose_in(t.part) * held_->mesh->vertices[vertex];
  NearFace near;
  near.squared = reach_ * reach_;
  asked(Ask::corner_of_a, t.part, vertex, region_or_face(B, t.b));
  around.find_in_region(p, t.b, near);
  int fresh = near.face == kNone ? 0 : start_on_b(t.part, vertex, near);
  // A plane may be several regions (T-junctions, islands): the corner stands on the one that is under it.
  near.face = kNone;
  near.squared *= kSameDistance;
  const Vec3& n = B.topology.face_normals[t.b];
  around.find(p, near,
              [&B, &n](std::uint32_t face) { return std::abs(n.dot(B.topology.face_normals[face])) > kParallel; });
  if (near.face != kNone) fresh += start_on_b(t.part, vertex, near);
  return fresh;
}

int ContactSet::seed_crossings(const FacePair& t) {
  Outline a, b;
  if (!outline(*held_, t.a, a) || !outline(*fixed_[t.part].surface, t.b, b)) return 0;
  const Pose& X_BA = pose_in(t.part);
  for (std::size_t i = 0; i < a.size; ++i) a.p[i] = X_BA * a.p[i];
  int fresh = 0;
  for (std::size_t i = 0; i < a.size && !out_of_time(); ++i)
    for (std::size_t j = 0; j < b.size; ++j) {
      const Simplex of_a{2, {a.p[i], a.p[(i + 1) % a.size]}}, of_b{2, {b.p[j], b.p[(j + 1) % b.size]}};
      if (!may_be_inside_both(of_a, of_b)) continue;
      const ClosestPoints c = closest_points(of_a, of_b);
      if (c.mask_a != 3 || c.mask_b != 3 || c.squared_distance > reach_ * reach_) continue;
      // The outline may be many edges of the mesh, or pass by a bay: the faces that are there now.
      NearFace on_a, on_b;
      on_a.squared = on_b.squared = reach_ * reach_;
      near_held_.find_in_region(X_BA.inverse() * c.a, t.a, on_a);
      near_fixed_[t.part].find_in_region(c.b, t.b, on_b);
      if (on_a.face != kNone && on_b.face != kNone) fresh += seed_rims({t.part, on_a.face, on_b.face});
    }
  return fresh;
}

int ContactSet::seed_corners(const FacePair& t) {
  int fresh = 0;
  for (const std::uint32_t v : held_->mesh->triangles[t.a]) fresh += seed_vertex_of_a(t.part, v, t.b);
  for (const std::uint32_t v : fixed_[t.part].surface->mesh->triangles[t.b]) fresh += seed_vertex_of_b(t.part, t.a, v);
  return fresh;
}

int ContactSet::seed_vertex_of_a(std::uint32_t part, std::uint32_t vertex, std::uint32_t face_b) {
  if (held_->topology.vertex_flat[vertex] != 0 ||
      asked(Ask::corner_of_a, part, vertex, region_or_face(*fixed_[part].surface, face_b)))
    return 0;
  NearFace near;
  near.squared = reach_ * reach_;
  near_fixed_[part].find_in_region(pose_in(part) * held_->mesh->vertices[vertex], face_b, near);
  return near.face == kNone ? 0 : start_on_b(part, vertex, near);
}

int ContactSet::start_on_b(std::uint32_t part, std::uint32_t vertex, const NearFace& near) {
  const Surface& B = *fixed_[part].surface;
  return start(part, {FeatureKind::vertex, vertex}, subfeature(B, {FeatureKind::face, near.face}, near.mask));
}

int ContactSet::seed_vertex_of_b(std::uint32_t part, std::uint32_t face_a, std::uint32_t vertex) {
  const Surface& B = *fixed_[part].surface;
  if (B.topology.vertex_flat[vertex] != 0 || asked(Ask::corner_of_b, part, region_or_face(*held_, face_a), vertex))
    return 0;
  NearFace near;
  near.squared = reach_ * reach_;
  near_held_.find_in_region(pose_in(part).inverse() * B.mesh->vertices[vertex], face_a, near);
  if (near.face == kNone) return 0;
  return start(part, subfeature(*held_, {FeatureKind::face, near.face}, near.mask), {FeatureKind::vertex, vertex});
}

int ContactSet::seed_rims(const FacePair& t) {
  const Surface& B = *fixed_[t.part].surface;
  const Pose& X_BA = pose_in(t.part);
  const auto rim = [](const Surface& s, std::uint32_t edge) { return s.topology.edges[edge].kind != EdgeKind::flat; };
  int fresh = 0;
  for (const std::uint32_t ea : held_->topology.face_edges[t.a]) {
    if (!rim(*held_, ea)) continue;
    const Feature a{FeatureKind::edge, ea};
    Simplex sa = corners(*held_, a);
    for (int k = 0; k < sa.size; ++k) sa.p[static_cast<std::size_t>(k)] = X_BA * sa.p[static_cast<std::size_t>(k)];
    for (const std::uint32_t eb : B.topology.face_edges[t.b]) {
      if (!rim(B, eb)) continue;
      const Feature b{FeatureKind::edge, eb};
      const Simplex sb = corners(B, b);
      if (!may_be_inside_both(sa, sb)) continue;
      const ClosestPoints c = closest_points(sa, sb);
      if (c.mask_a == 3 && c.mask_b == 3 && c.squared_distance <= reach_ * reach_) fresh += start(t.part, a, b);
    }
  }
  return fresh;
}

int ContactSet::start(std::uint32_t part, Feature a, Feature b) {
  if (known(part, a, b) || asked(Ask::features, part, number(a), number(b))) return 0;
  return take(part, walk_to_minimum(*held_, *fixed_[part].surface, pose_in(part), a, b), false);
}

int ContactSet::take(std::uint32_t part, const FeaturePair& at, bool support) {
  if (at.distance > reach_ || known(part, at.a, at.b) || next_.size() == next_.capacity()) return 0;
  if (redundant(part, at.a, at.b) != support) return 0;
  if (support && spoken_for(constraint_of(part, at, 0), part, constraints_, owners_)) return 0;
  remember({part, at.a, at.b, 0, support, false});
  add_constraints(static_cast<std::uint32_t>(next_.size() - 1), at, constraints_, owners_);
  return 1;
}

bool ContactSet::spoken_for(const Contact& constraint, std::uint32_t part, const std::vector<Contact>& constraints,
                            const std::vector<std::uint32_t>& owners) const {
  const Vec3 u = constraint.n.unitOrthogonal(), v = constraint.n.cross(u);
  Surrounded surrounded;
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    const Contact& c = constraints[i];
    if (owners[i] == kNone || next_[owners[i]].part != part || c.n.dot(constraint.n) < kSameNormal) continue;
    const Vec3 away = c.r - constraint.r;
    if (c.gap > constraint.gap + kSlope * away.norm() + kSameGap) continue;
    if (surrounded.add(away.dot(u), away.dot(v))) return true;
  }
  return false;
}

}  // namespace tegotae
