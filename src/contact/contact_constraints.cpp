// What a pair of features asks of the motion.
#include <algorithm>

#include "contact/contact_set.hpp"
#include "contact/separating_axis.hpp"
#include "feature/simplex_distance.hpp"
#include "tegotae/core/clock.hpp"

namespace tegotae {

int ContactSet::add_cutting_planes(const std::vector<FacePair>& triangles, const Displacement& d, double clearance,
                                   std::int64_t deadline_ns) {
  int added = 0;
  const Vec3& c = center_W_;
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
    const Feature face_a{FeatureKind::face, t.a}, face_b{FeatureKind::face, t.b};
    if (!add({axis.n, a[axis.corner] - c, axis.gap, B.part, kOneShotAge, face_a, face_b}, constraints_)) continue;
    owners_.push_back(kNone);
    cut_.push_back(t);
    ++added;
  }
  return added;
}

bool ContactSet::touches(std::size_t constraint, double distance) const noexcept {
  const Contact& c = constraints_[constraint];
  return std::any_of(cut_.begin(), cut_.end(), [&](const FacePair& t) {
    if (t.a != c.feature_a.index || t.b != c.feature_b.index || !(fixed_[t.part].part == c.part)) return false;
    // The triangles as they are: one that has collapsed in welding has no edges to walk over.
    Simplex a = corners(*held_, c.feature_a);
    const Pose& X_BA = pose_in(t.part);
    for (Vec3& p : a.p) p = X_BA * p;
    const Simplex b = corners(*fixed_[t.part].surface, c.feature_b);
    return closest_points(a, b).squared_distance <= distance * distance;
  });
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

Contact ContactSet::constraint_of(std::uint32_t part, const FeaturePair& at, int age) const {
  const FixedSurface& B = fixed_[part];
  const Vec3 n = B.X_WB.q * normal_B(part, at);
  return {n, B.X_WB * at.p_a - center_W_, at.distance, B.part, age, at.a, at.b};
}

void ContactSet::add_constraints(std::uint32_t pair, const FeaturePair& at, std::vector<Contact>& constraints,
                                 std::vector<std::uint32_t>& owners) {
  if (add(constraint_of(next_[pair].part, at, next_[pair].age), constraints)) owners.push_back(pair);
  add_reflex_constraints(pair, at, constraints, owners);
}

void ContactSet::add_reflex_constraints(std::uint32_t pair, const FeaturePair& at, std::vector<Contact>& constraints,
                                        std::vector<std::uint32_t>& owners) {
  // A corner that hovers over one side of a concave edge is limited by the face on the other side too, although its
  // projection on that face lies just outside: without that constraint it slides along its face into the other one.
  const bool corner_of_a = at.a.kind == FeatureKind::vertex && at.b.kind == FeatureKind::face;
  const bool corner_of_b = at.b.kind == FeatureKind::vertex && at.a.kind == FeatureKind::face;
  if (!corner_of_a && !corner_of_b) return;
  const std::uint32_t part = next_[pair].part;
  const FixedSurface& B = fixed_[part];
  const Surface& s = corner_of_a ? *B.surface : *held_;
  const std::uint32_t face = corner_of_a ? at.b.index : at.a.index;
  const Pose& X_BA = pose_in(part);
  const Vec3 corner = corner_of_a ? at.p_a : X_BA.inverse() * at.p_b;  // in the frame of `s`
  // Seen from the back of an open surface its convex edges are the concave ones.
  const Vec3& own = s.topology.face_normals[face];
  const double side = own.dot(corner - s.mesh->vertices[s.mesh->triangles[face][0]]) < 0 ? -1 : 1;
  for (const std::uint32_t e : s.topology.face_edges[face]) {
    const Topology::Edge& edge = s.topology.edges[e];
    if (edge.kind != (side > 0 ? EdgeKind::concave : EdgeKind::convex)) continue;
    const std::uint32_t other = edge.f[0] == face ? edge.f[1] : edge.f[0];
    const Vec3 n = side * s.topology.face_normals[other];
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
    const Feature across{FeatureKind::face, other};
    const Contact constraint{n_W,
                             on_a_W - center_W_,
                             height,
                             B.part,
                             next_[pair].age,
                             corner_of_a ? at.a : across,
                             corner_of_a ? across : at.b};
    if (add(constraint, constraints)) owners.push_back(pair);
  }
}

bool ContactSet::add(const Contact& contact, std::vector<Contact>& constraints) {
  if (static_cast<int>(constraints.size()) >= capacity_) {
    ++overflow_;
    return false;
  }
  constraints.push_back(contact);
  return true;
}

}  // namespace tegotae
