#include "narrowphase/backing.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>

namespace tegotae {
namespace {

/// The depth, as a share of the surface's radius: some times what curves within a block of faces, so that whole blocks
/// tell that nothing is near what was drawn out.
constexpr double kDepth = 0.1;
/// A solid whose mean thickness is more than this share of the depth leaves as fast by its own faces.
constexpr double kThin = 0.25;
/// A face is drawn out where the cosine between its normal and the axis is no less, and enough of them have to be.
constexpr double kLeastFacing = 0.1, kEnoughFaces = 0.8;
/// Triangles of walls for each face, at most.
constexpr double kMostWalls = 0.25;
/// A point is on a face where it is nearer than this share of the depth, or of the faces' size to their edges.
constexpr double kNear = 1e-6, kGrazing = 1e-9;

/// The axis that normals are nearest to, up to its sign; and the mean thickness if the surface is closed.
struct Shape {
  Vec3 axis = Vec3::UnitZ();
  double thickness = 0;
};

Shape shape_of(const PatchTree& tree) {
  Mat3 sum = Mat3::Zero();
  double area = 0, volume = 0;
  for (std::uint32_t f = 0; f < tree.order().size(); ++f) {
    const Vec3 a = tree.corner(f, 0) - tree.origin(), b = tree.corner(f, 1) - tree.origin(),
               c = tree.corner(f, 2) - tree.origin();
    const Vec3 n = (b - a).cross(c - a);
    const double size = n.norm();
    if (!(size > 0)) continue;
    sum += n * n.transpose() / size;
    area += size / 2;
    volume += a.dot(b.cross(c)) / 6;
  }
  Shape out;
  if (!(area > 0)) return out;
  out.axis = Eigen::SelfAdjointEigenSolver<Mat3>(sum).eigenvectors().col(2);
  out.thickness = 2 * std::abs(volume) / area;
  return out;
}

/// Edges of drawn faces that no other one of them continues: each has a wall.
std::vector<std::array<std::uint32_t, 2>> rims(const TriangleMesh& mesh, const std::vector<int>& sides) {
  struct HalfEdge {
    std::array<std::uint32_t, 2> v;
    int turn;
    bool operator<(const HalfEdge& other) const { return v < other.v; }
  };
  std::vector<HalfEdge> all;
  for (std::size_t f = 0; f < sides.size(); ++f) {
    if (sides[f] == 0) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[f][k], b = mesh.triangles[f][(k + 1) % 3];
      all.push_back({{std::min(a, b), std::max(a, b)}, a < b ? sides[f] : -sides[f]});
    }
  }
  std::sort(all.begin(), all.end());
  std::vector<std::array<std::uint32_t, 2>> out;
  for (std::size_t i = 0; i < all.size();) {
    int turns = 0;
    const std::size_t first = i;
    for (; i < all.size() && all[i].v == all[first].v; ++i) turns += all[i].turn;
    if (turns != 0) out.push_back(all[first].v);
  }
  return out;
}

std::shared_ptr<const PatchTree> walls_under(const TriangleMesh& mesh,
                                             const std::vector<std::array<std::uint32_t, 2>>& edges, const Vec3& out) {
  if (edges.empty()) return nullptr;
  auto walls = std::make_shared<TriangleMesh>();
  for (const auto& edge : edges) {
    const auto first = static_cast<std::uint32_t>(walls->vertices.size());
    for (const std::uint32_t v : edge) walls->vertices.push_back(mesh.vertices[v]);
    for (const std::uint32_t v : edge) walls->vertices.push_back(mesh.vertices[v] + out);
    walls->triangles.push_back({first, first + 1, first + 3});
    walls->triangles.push_back({first, first + 3, first + 2});
  }
  return std::make_shared<const PatchTree>(walls);
}

}  // namespace

std::shared_ptr<const Backing> Backing::of(const std::shared_ptr<const PatchTree>& tree, const Facing* facing) {
  const Shape shape = shape_of(*tree);
  const double depth = kDepth * tree->radius();
  if (facing != nullptr && shape.thickness > kThin * depth) return nullptr;
  auto backing = std::shared_ptr<Backing>(new Backing(tree));
  backing->out_ = depth * shape.axis;
  std::vector<int> sides;
  std::vector<std::uint32_t> drawn;
  for (std::uint32_t f = 0; f < tree->order().size(); ++f) {
    const Vec3 n = normal_of(*tree, f);
    const double along = n.dot(shape.axis);
    const int side = along > kLeastFacing ? 1 : along < -kLeastFacing ? -1 : 0;
    sides.push_back(side);
    if (side != 0) drawn.push_back(f);
    backing->faces_.push_back(side == 0 ? NormalCone{} : NormalCone::about(side * n, 1));
  }
  const auto faces = static_cast<double>(sides.size());
  const auto edges = rims(tree->mesh(), sides);
  if (static_cast<double>(drawn.size()) < kEnoughFaces * faces) return nullptr;
  if (2 * static_cast<double>(edges.size()) > kMostWalls * faces) return nullptr;
  backing->columns_ = FaceColumns(*tree, shape.axis, drawn);
  for (const Side side : {Side::plus, Side::minus})
    backing->walls_[static_cast<std::size_t>(side)] = walls_under(tree->mesh(), edges, backing->drawn(side));
  return backing;
}

bool Backing::outside(const Vec3& p, Side side) const noexcept {
  const Vec3 from = p - tree_->origin(), along = -drawn(side);
  const double depth = out_.norm(), at = from.dot(out_) / depth, slack = 2 * kNear * depth;
  const double low = at - (side == Side::plus ? depth : 0) - slack,
               high = at + (side == Side::plus ? 0 : depth) + slack;
  // Most parts of an assembly are not beside it.
  if (!columns_.reach(low, high)) return true;
  for (const auto& [face_low, face_high, face] : columns_.beside(from)) {
    if (face_high < low || face_low > high) continue;
    std::array<Vec3, 3> v;
    double size = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      v[k] = tree_->corner(face, static_cast<int>(k)) - p;
      size = std::max(size, v[k].squaredNorm());
    }
    // On which side of each edge the line passes.
    const double least = kGrazing * size * along.norm();
    bool left = false, right = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const double passes = along.dot(v[k].cross(v[(k + 1) % 3]));
      left = left || passes > least;
      right = right || passes < -least;
    }
    if (left && right) continue;
    const Vec3 normal = (v[1] - v[0]).cross(v[2] - v[0]);
    const double share = normal.dot(v[0]) / normal.dot(along);
    if (share > -kNear && share < 1 + kNear) return false;
  }
  return true;
}

}  // namespace tegotae
