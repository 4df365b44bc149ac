#include <algorithm>
#include <cmath>

#include "import/round_faces.hpp"

namespace tegotae {
namespace {

// What two mating surfaces may differ by in radius and in the place of their axes: a share of the radius, or a length
// (m). Generous: a pair too many costs facets only.
constexpr double kShare = 0.03;
constexpr double kLength = 0.2e-3;
constexpr double kAngle = 2e-3;  // rad, between axes

/// A face of a part in the world.
struct Placed {
  std::size_t part, face;
  const CadFace* cad;
  Vec3 point, axis;
  Eigen::AlignedBox3d box;
};

std::vector<Placed> placed_faces(const std::vector<std::vector<CadFace>>& faces,
                                 const std::vector<AssemblyPart>& parts) {
  std::vector<Placed> all;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const std::vector<CadFace>& own = faces[parts[p].shape];
    for (std::size_t f = 0; f < own.size(); ++f) {
      if (own[f].kind == FaceKind::plane || own[f].box.isEmpty()) continue;
      const Pose& X = parts[p].pose;
      const Eigen::AffineCompact3d map = Eigen::Translation3d(X.p) * X.q;
      all.push_back({p, f, &own[f], X * own[f].point, X.q * own[f].axis, own[f].box.transformed(map)});
    }
  }
  return all;
}

bool mate(const Placed& a, const Placed& b) {
  if (a.cad->kind != b.cad->kind) return false;
  if (a.cad->kind == FaceKind::other) return true;  // nothing is known of them but that they are near
  if (a.cad->hole == b.cad->hole) return false;
  const double room = kLength + kShare * std::max(a.cad->radius, b.cad->radius);
  const Vec3 between = b.point - a.point;
  if (a.cad->kind == FaceKind::sphere) return between.norm() < room && std::abs(a.cad->radius - b.cad->radius) < room;
  if (a.axis.cross(b.axis).norm() > kAngle) return false;
  if (a.cad->kind == FaceKind::torus && between.norm() > room) return false;
  if ((between - a.axis * a.axis.dot(between)).norm() > room) return false;
  return a.cad->kind == FaceKind::cone || std::abs(a.cad->radius - b.cad->radius) < room;
}

}  // namespace

std::vector<FacePairing> mating_faces(const std::vector<std::vector<CadFace>>& faces,
                                      const std::vector<AssemblyPart>& parts) {
  std::vector<Placed> all = placed_faces(faces, parts);
  std::sort(all.begin(), all.end(), [](const Placed& a, const Placed& b) { return a.box.min().x() < b.box.min().x(); });
  std::vector<FacePairing> pairs;
  for (std::size_t i = 0; i < all.size(); ++i) {
    Eigen::AlignedBox3d reach = all[i].box;
    const double room = kLength + kShare * all[i].cad->radius;
    reach.min().array() -= room;
    reach.max().array() += room;
    for (std::size_t j = i + 1; j < all.size() && all[j].box.min().x() <= reach.max().x(); ++j) {
      if (all[i].part == all[j].part || !reach.intersects(all[j].box) || !mate(all[i], all[j])) continue;
      pairs.push_back({all[i].part, all[i].face, all[j].part, all[j].face});
    }
  }
  return pairs;
}

}  // namespace tegotae
