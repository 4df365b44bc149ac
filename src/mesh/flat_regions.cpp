#include "mesh/flat_regions.hpp"

#include <algorithm>
#include <cmath>

#include "tegotae/core/constants.hpp"

namespace tegotae {
namespace {

/// A vertex in the plane of its region.
struct PlanePoint {
  double x, y;
  std::uint32_t vertex;
};

double turn(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The corners of the convex hull of `points` (which it sorts), counterclockwise (Andrew's monotone chain).
std::vector<PlanePoint> convex_hull(std::vector<PlanePoint>& points) {
  std::sort(points.begin(), points.end(), [](const PlanePoint& a, const PlanePoint& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.vertex < b.vertex;
  });
  std::vector<PlanePoint> hull;
  const auto chain = [&hull](const PlanePoint& p, std::size_t least) {
    while (hull.size() >= least + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
    hull.push_back(p);
  };
  for (const PlanePoint& p : points) chain(p, 0);
  const std::size_t lower = hull.size() - 1;
  for (std::size_t i = points.size() - 1; i-- > 0;) chain(points[i], lower);
  if (hull.size() > 1) hull.pop_back();  // the first once more
  return hull;
}

class RegionFinder {
 public:
  RegionFinder(const TriangleMesh& mesh, const Topology& topology)
      : mesh_(mesh), topology_(topology), seen_(mesh.vertices.size(), kNone) {}

  FlatRegions find() {
    regions_.of_face.assign(mesh_.triangles.size(), kNone);
    regions_.corner_begin.assign(1, 0);
    std::vector<std::uint8_t> done(mesh_.triangles.size(), 0);
    for (std::uint32_t f = 0; f < mesh_.triangles.size(); ++f) {
      if (done[f] != 0 || topology_.face_normals[f].isZero(0)) continue;
      flood(f, done);
      if (faces_.size() > 1) add_region();
    }
    return std::move(regions_);
  }

 private:
  /// Collects the region of `seed` in faces_. All are compared with its normal: compared with their neighbors, the
  /// faces of a finely divided cylinder would be one plane.
  void flood(std::uint32_t seed, std::vector<std::uint8_t>& done) {
    const Vec3& n = topology_.face_normals[seed];
    faces_.assign(1, seed);
    done[seed] = 1;
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t twin = topology_.twin[3 * faces_[i] + static_cast<std::uint32_t>(k)];
        const std::uint32_t edge = topology_.face_edges[faces_[i]][static_cast<std::size_t>(k)];
        if (twin == kNone || topology_.edges[edge].kind != EdgeKind::flat) continue;
        const std::uint32_t next = twin / 3;
        const Vec3& m = topology_.face_normals[next];
        if (done[next] != 0 || n.dot(m) < 0 || n.cross(m).norm() >= kFlatAngle) continue;
        done[next] = 1;
        faces_.push_back(next);
      }
    }
  }

  void add_region() {
    const auto region = static_cast<std::uint32_t>(regions_.corner_begin.size() - 1);
    const Vec3& n = topology_.face_normals[faces_[0]];
    const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
    const Vec3& origin = mesh_.vertices[mesh_.triangles[faces_[0]][0]];
    points_.clear();
    for (const std::uint32_t f : faces_) {
      regions_.of_face[f] = region;
      for (const std::uint32_t w : mesh_.triangles[f]) {
        if (seen_[w] == region || topology_.vertex_flat[w] != 0) continue;  // inside: no corner of a hull
        seen_[w] = region;
        const Vec3 p = mesh_.vertices[w] - origin;
        points_.push_back({p.dot(u), p.dot(v), w});
      }
    }
    if (!points_.empty()) add_corners(convex_hull(points_));
    regions_.corner_begin.push_back(static_cast<std::uint32_t>(regions_.corners.size()));
  }

  void add_corners(const std::vector<PlanePoint>& hull) {
    if (hull.size() <= kMaxRegionCorners) {
      for (const PlanePoint& p : hull) regions_.corners.push_back(p.vertex);
      return;
    }
    const std::size_t begin = regions_.corners.size();
    for (std::size_t k = 0; k < kMaxRegionCorners; ++k) {
      const double angle = 2 * M_PI * static_cast<double>(k) / kMaxRegionCorners;
      const double x = std::cos(angle), y = std::sin(angle);
      const auto farthest = std::max_element(
          hull.begin(), hull.end(),
          [x, y](const PlanePoint& a, const PlanePoint& b) { return x * a.x + y * a.y < x * b.x + y * b.y; });
      const auto first = regions_.corners.begin() + static_cast<std::ptrdiff_t>(begin);
      if (std::find(first, regions_.corners.end(), farthest->vertex) == regions_.corners.end())
        regions_.corners.push_back(farthest->vertex);
    }
  }

  const TriangleMesh& mesh_;
  const Topology& topology_;
  FlatRegions regions_;
  std::vector<std::uint32_t> faces_;
  std::vector<PlanePoint> points_;
  std::vector<std::uint32_t> seen_;  // of each vertex: the region that has it last
};

}  // namespace

FlatRegions find_flat_regions(const TriangleMesh& mesh, const Topology& topology) {
  return RegionFinder(mesh, topology).find();
}

}  // namespace tegotae
