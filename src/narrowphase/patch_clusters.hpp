#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

inline constexpr std::uint32_t kNoCluster = 0xffffffffu;
/// Weight of the diameter against the thickness of a patch (design.md 4b): decides only where surfaces are flat.
inline constexpr double kDiameterWeight = 3e-4;

/// A triangle relative to the origin of the tree.
struct PatchItem {
  std::array<Eigen::Vector3f, 3> v;
  Eigen::Vector3f normal;
  float area;
};

/// Area moments of a set of triangles, up to second order.
struct PatchMoments {
  double w = 0;
  double x = 0, y = 0, z = 0;
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

  PatchMoments& operator+=(const PatchMoments& o) {
    w += o.w, x += o.x, y += o.y, z += o.z;
    xx += o.xx, yy += o.yy, zz += o.zz, xy += o.xy, xz += o.xz, yz += o.yz;
    return *this;
  }

  /// ∫ over the triangle, by the sum over its corners and its center: A/12 (Σ v vᵀ + 9 g gᵀ).
  static PatchMoments of(const PatchItem& t) {
    const double w = t.area, k = w / 12;
    const auto& [a, b, c] = t.v;
    const double sx = double{a.x()} + b.x() + c.x(), sy = double{a.y()} + b.y() + c.y(),
                 sz = double{a.z()} + b.z() + c.z();
    auto sum = [&, &p = a, &q = b, &r = c](int i, int j, double si, double sj) {
      return k * (double{p[i]} * p[j] + double{q[i]} * q[j] + double{r[i]} * r[j] + si * sj);
    };
    PatchMoments m;
    m.w = w, m.x = w / 3 * sx, m.y = w / 3 * sy, m.z = w / 3 * sz;
    m.xx = sum(0, 0, sx, sx), m.yy = sum(1, 1, sy, sy), m.zz = sum(2, 2, sz, sz);
    m.xy = sum(0, 1, sx, sy), m.xz = sum(0, 2, sx, sz), m.yz = sum(1, 2, sy, sz);
    return m;
  }

  Mat3 covariance() const {
    const double i = w > 0 ? 1 / w : 0;
    const double mx = x * i, my = y * i, mz = z * i;
    Mat3 c;
    c << xx * i - mx * mx, xy * i - mx * my, xz * i - mx * mz,  //
        xy * i - mx * my, yy * i - my * my, yz * i - my * mz,   //
        xz * i - mx * mz, yz * i - my * mz, zz * i - mz * mz;
    return c;
  }
};

/// Two clusters joined: `left` and `right` are clusters; a single face has none.
struct PatchJoin {
  std::uint32_t left = kNoCluster, right = kNoCluster;
  std::uint32_t faces = 1;
};

/// Faces clustered from the bottom: the first joins are the faces, each later one joins two earlier ones.
struct PatchClusters {
  std::vector<PatchJoin> joins;
  std::vector<PatchMoments> moments;  ///< of each join
  std::uint32_t root = 0;
};

/// Clusters the faces of `mesh`: neighbors over an edge that are each other's best partner are joined, round after
/// round, by the thickness + kDiameterWeight · diameter of the two together, more where they meet in sharp edges only;
/// what has no common edge is joined by place. Time is nearly linear in the number of faces. `items` are the faces in
/// order.
PatchClusters cluster_patches(const TriangleMesh& mesh, const std::vector<PatchItem>& items);

}  // namespace tegotae
