#include "narrowphase/normal_cone.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "narrowphase/self_contact.hpp"

namespace tegotae {
namespace {

/// Cosines are kept in single precision, and those of normals that were computed err by less.
constexpr double kConeSlack = 1e-6;
/// Wider cones are none: only what nearly turns back from a motion would leave by them.
constexpr double kLeastCos = 0.02;

}  // namespace

NormalCone NormalCone::about(const Vec3& axis, double least) {
  NormalCone out;
  const double cos = least - kConeSlack;
  if (!(cos > kLeastCos)) return out;
  for (int i = 0; i < 3; ++i) out.axis[static_cast<std::size_t>(i)] = static_cast<float>(axis[i]);
  out.cos = static_cast<float>(cos);
  out.sin = static_cast<float>(std::sqrt(std::max(0.0, 1 - cos * cos)) + kConeSlack);
  return out;
}

NormalCone NormalCone::around(const std::vector<NormalCone>& of_faces, const std::vector<std::uint32_t>& faces) {
  const auto axis_of = [&](std::uint32_t face) -> Vec3 {
    return Eigen::Map<const Eigen::Vector3f>(of_faces[face].axis.data()).cast<double>();
  };
  Vec3 sum = Vec3::Zero();
  for (const std::uint32_t face : faces) sum += axis_of(face);
  if (!(sum.norm() > 0)) return {};
  const Vec3 axis = sum.normalized();
  double least = 1;
  for (const std::uint32_t face : faces) least = std::min(least, axis.dot(axis_of(face)));
  return about(axis, least);
}

double NormalCone::least(const Vec3& v) const {
  if (!(cos > 0)) return -std::numeric_limits<double>::infinity();
  const Vec3 m(double{axis[0]}, double{axis[1]}, double{axis[2]});
  return m.dot(v) * double{cos} - m.cross(v).norm() * double{sin};
}

Vec3 normal_of(const PatchTree& tree, std::uint32_t face) {
  const Vec3 e = tree.corner(face, 1) - tree.corner(face, 0), f = tree.corner(face, 2) - tree.corner(face, 0);
  const Vec3 n = e.cross(f);
  const double longest2 = std::max({e.squaredNorm(), f.squaredNorm(), (f - e).squaredNorm()});
  return n.norm() > kThinFace * longest2 ? n.normalized() : Vec3(Vec3::Zero());
}

}  // namespace tegotae
