#include "narrowphase/patch_tree.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel_for.hpp"
#include "narrowphase/patch_clusters.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

/// Mean normal of a patch, relative to its area, above which it is nearly flat (normals within some 15°).
constexpr float kNearlyFlat = 0.98f;
/// Patches of more faces lie along their largest variance; smaller ones, whose outlines meet the other part's, along
/// their outline.
constexpr std::uint32_t kOutlineFaces = 1024;
/// Relative enlargement of boxes: covers rounding of the fit (double) and of the stored half extents.
constexpr double kFitSlack = 1e-6;
/// Rounding of the single-precision copies of the vertices, relative to the mesh's radius (half a step is 2^-25).
constexpr double kCopySlack = 1.0 / (1 << 24);
/// Faces thinner than this part of their longest edge have no plane to speak of.
constexpr double kFlatFace = 1e-9;

using Vec3f = Eigen::Vector3f;

struct Point2 {
  double x, y;
};

double turn(const Point2& o, const Point2& a, const Point2& b) {
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

/// Drops points inside the octagon of the extreme points in eight directions: they are not on the hull.
void drop_inner(std::vector<Point2>& points) {
  std::array<Point2, 8> corner;
  corner.fill(points[0]);
  constexpr std::array<std::array<double, 2>, 8> kAround{
      {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
  for (const Point2& p : points) {
    for (int k = 0; k < 8; ++k) {
      const auto& [x, y] = kAround[k];
      if (x * p.x + y * p.y > x * corner[k].x + y * corner[k].y) corner[k] = p;
    }
  }
  points.erase(std::remove_if(points.begin(), points.end(),
                              [&](const Point2& p) {
                                for (int k = 0; k < 8; ++k) {
                                  const Point2 &a = corner[k], &b = corner[(k + 1) % 8];
                                  if ((a.x != b.x || a.y != b.y) && turn(a, b, p) <= 0) return false;
                                }
                                return true;
                              }),
               points.end());
}

/// Direction of a side of the enclosing rectangle of least area: it lies along an edge of the hull (Freeman and
/// Shapira, 1975). Reorders and drops points; `hull` is scratch.
Point2 narrowest(std::vector<Point2>& points, std::vector<Point2>& hull) {
  constexpr std::size_t kWorthFiltering = 24;
  // The long edges are the straight sides of a patch; the short ones of a round outline do not matter.
  constexpr std::size_t kLongestEdges = 8;
  if (points.size() > kWorthFiltering) drop_inner(points);
  std::sort(points.begin(), points.end(),
            [](const Point2& a, const Point2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  // Monotone chain (Andrew, 1979), lower and upper part one after the other.
  hull.resize(2 * points.size());
  std::size_t n = 0;
  auto add = [&](const Point2& p, std::size_t least) {
    while (n >= least && turn(hull[n - 2], hull[n - 1], p) <= 0) --n;
    hull[n++] = p;
  };
  for (const Point2& p : points) add(p, 2);
  const std::size_t upper = n + 1;
  for (auto p = points.rbegin() + 1; p < points.rend(); ++p) add(*p, upper);
  if (n > 1) --n;  // the first point again
  std::array<Point2, kLongestEdges> edge;
  std::size_t edges = 0;
  auto longer = [](const Point2& a, const Point2& b) { return a.x * a.x + a.y * a.y > b.x * b.x + b.y * b.y; };
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 e{hull[(i + 1) % n].x - hull[i].x, hull[(i + 1) % n].y - hull[i].y};
    if (edges < kLongestEdges) {
      edge[edges++] = e;
      std::push_heap(edge.begin(), edge.begin() + edges, longer);
    } else if (longer(e, edge[0])) {
      std::pop_heap(edge.begin(), edge.end(), longer);
      edge.back() = e;
      std::push_heap(edge.begin(), edge.end(), longer);
    }
  }
  Point2 best{1, 0};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < edges; ++i) {
    const double length = std::sqrt(edge[i].x * edge[i].x + edge[i].y * edge[i].y);
    if (!(length > 0)) continue;
    const double dx = edge[i].x / length, dy = edge[i].y / length;
    const Point2& a = hull[0];
    double lo = 0, hi = 0, low = 0, high = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const double px = hull[k].x - a.x, py = hull[k].y - a.y;
      const double along = px * dx + py * dy, across = py * dx - px * dy;
      lo = std::min(lo, along);
      hi = std::max(hi, along);
      low = std::min(low, across);
      high = std::max(high, across);
    }
    high -= low;
    // A line has no area; any direction but its own would give it some.
    const double area = (hi - lo) * high + 1e-9 * (hi - lo + high) * (hi - lo + high);
    if (area < least) least = area, best = {dx, dy};
  }
  return best;
}

/// Nodes that a thread fits before it asks for more.
constexpr std::size_t kFitAtOnce = 4096;

/// Lays the clusters out as nodes with fitted boxes. Each box depends on its patch alone, so they are the same whatever
/// the number of threads.
class Layout {
 public:
  Layout(const TriangleMesh& mesh, const PatchClusters& clusters, const std::vector<PatchItem>& items, double radius,
         std::vector<PatchNode>& nodes, std::vector<std::uint32_t>& order)
      : clusters_(clusters), copy_slack_(radius * kCopySlack), nodes_(nodes), order_(order) {
    order_.reserve(items.size());
    const std::uint32_t root = clusters.root;
    const std::size_t inner = collect(root);
    number_vertices(mesh, items);
    sum_normals(items);
    nodes_.reserve(2 * inner + 1);
    nodes_.emplace_back();
    std::vector<Place> stack{{0, root, 0}};
    places_.reserve(2 * inner + 1);
    while (!stack.empty()) {
      const Place p = stack.back();
      stack.pop_back();
      const PatchJoin& j = clusters_.joins[p.cluster];
      places_.push_back(p);
      if (j.faces <= kPatchLeaf) {
        nodes_[p.node].first = p.begin;
        nodes_[p.node].count = j.faces;
        continue;
      }
      const auto child = static_cast<std::uint32_t>(nodes_.size());
      nodes_[p.node].first = child;
      nodes_[p.node].count = 0;
      nodes_.emplace_back();
      nodes_.emplace_back();
      stack.push_back({child + 1, j.right, p.begin + clusters_.joins[j.left].faces});
      stack.push_back({child, j.left, p.begin});
    }
    const std::size_t tasks = (places_.size() + kFitAtOnce - 1) / kFitAtOnce;
    parallel_for(static_cast<int>(tasks), 0, [&](int task) { fit_some(static_cast<std::size_t>(task)); }, {});
  }

 private:
  struct Place {
    std::uint32_t node, cluster, begin;
  };
  /// Memory of one thread.
  struct Scratch {
    std::vector<Vec3> points;
    std::vector<Point2> outline, hull;
  };

  void fit_some(std::size_t task) const {
    Scratch scratch;
    for (std::size_t i = task * kFitAtOnce; i < std::min(places_.size(), (task + 1) * kFitAtOnce); ++i) {
      const Place& p = places_[i];
      fit(p.node, p.cluster, p.begin, p.begin + clusters_.joins[p.cluster].faces, scratch);
    }
  }

  /// Faces in the order of the leaves; returns how many nodes are none.
  std::size_t collect(std::uint32_t root) {
    std::vector<std::uint32_t> stack{root};
    std::size_t inner = 0;
    while (!stack.empty()) {
      const std::uint32_t c = stack.back();
      stack.pop_back();
      const PatchJoin& j = clusters_.joins[c];
      inner += j.faces > kPatchLeaf;
      if (j.left == kNoCluster) {
        order_.push_back(c);
      } else {
        stack.push_back(j.right);
        stack.push_back(j.left);
      }
    }
    return inner;
  }

  /// Vertices in the order in which the faces of order_ first use them: those of a patch are then a range, and those
  /// that it shares with patches before it.
  void number_vertices(const TriangleMesh& mesh, const std::vector<PatchItem>& items) {
    std::vector<std::uint32_t> number(mesh.vertices.size(), kNoCluster);
    corners_.reserve(order_.size());
    first_.reserve(order_.size() + 1);
    vertices_.reserve(mesh.vertices.size());
    for (const std::uint32_t f : order_) {
      first_.push_back(static_cast<std::uint32_t>(vertices_.size()));
      corners_.emplace_back();
      for (int k = 0; k < 3; ++k) {
        std::uint32_t& v = number[mesh.triangles[f][k]];
        if (v == kNoCluster) {
          v = static_cast<std::uint32_t>(vertices_.size());
          vertices_.push_back(items[f].v[k]);
        }
        corners_.back()[k] = v;
      }
    }
    first_.push_back(static_cast<std::uint32_t>(vertices_.size()));
  }

  void sum_normals(const std::vector<PatchItem>& items) {
    normals_.reserve(clusters_.joins.size());
    for (std::size_t c = 0; c < clusters_.joins.size(); ++c) {
      const PatchJoin& j = clusters_.joins[c];
      normals_.push_back(j.left == kNoCluster ? Vec3f(items[c].area * items[c].normal)
                                              : Vec3f(normals_[j.left] + normals_[j.right]));
    }
  }

  /// The vertices of the faces at these places, few of them twice.
  void gather(std::uint32_t begin, std::uint32_t end, std::vector<Vec3>& points) const {
    points.clear();
    const std::uint32_t first = first_[begin];
    for (std::uint32_t v = first; v < first_[end]; ++v) points.push_back(vertices_[v].cast<double>());
    for (std::uint32_t i = begin; i < end; ++i) {
      for (const std::uint32_t v : corners_[i]) {
        if (v < first) points.push_back(vertices_[v].cast<double>());
      }
    }
  }

  void fit(std::uint32_t node, std::uint32_t cluster, std::uint32_t begin, std::uint32_t end, Scratch& scratch) const {
    const std::vector<Vec3>& points = scratch.points;
    gather(begin, end, scratch.points);
    const PatchMoments& m = clusters_.moments[cluster];
    const Vec3f& mean = normals_[cluster];
    const float length = mean.norm(), area = static_cast<float>(m.w);
    Vec3 normal = length > 0 ? Vec3((mean / length).cast<double>().normalized()) : Vec3(Vec3::UnitZ());
    // The least variance gives the thinner box where a patch is bent; the mean normal where its outline is ragged, and
    // it is all that a nearly flat patch needs. It says nothing where normals cancel.
    if (length < kNearlyFlat * area) {
      Eigen::SelfAdjointEigenSolver<Mat3> eigen;
      eigen.computeDirect(m.covariance());
      const Vec3 least = eigen.eigenvectors().col(0);
      const bool usable = least.allFinite() && std::abs(least.norm() - 1) < 1e-3;
      if (usable && (length < 0.5f * area || thickness(points, least) < thickness(points, normal))) {
        normal = least.normalized();
      }
    }
    Mat3 frame;
    if (end - begin <= kOutlineFaces) {
      const Vec3 u = normal.cross(std::abs(normal.x()) < 0.7 ? Vec3::UnitX() : Vec3::UnitY()).normalized();
      const Vec3 v = normal.cross(u);
      scratch.outline.clear();
      for (const Vec3& p : points) scratch.outline.push_back({p.dot(u), p.dot(v)});
      const auto [x, y] = narrowest(scratch.outline, scratch.hull);
      frame << (x * u + y * v).normalized(), (x * v - y * u).normalized(), normal;
    } else {
      Eigen::SelfAdjointEigenSolver<Mat3> eigen;
      eigen.computeDirect(m.covariance());
      const Vec3 longest = eigen.eigenvectors().col(2);
      Vec3 across = normal.cross(longest);
      if (!(across.norm() > 0.1)) across = normal.cross(std::abs(normal.x()) < 0.7 ? Vec3::UnitX() : Vec3::UnitY());
      across.normalize();
      frame << across.cross(normal), across, normal;
    }
    set_box(points, frame, nodes_[node]);
  }

  static double thickness(const std::vector<Vec3>& points, const Vec3& direction) {
    double lo = std::numeric_limits<double>::infinity(), hi = -lo;
    for (const Vec3& p : points) {
      const double x = direction.dot(p);
      lo = std::min(lo, x);
      hi = std::max(hi, x);
    }
    return hi - lo;
  }

  void set_box(const std::vector<Vec3>& points, const Mat3& frame, PatchNode& out) const {
    // Fitted in the frame as it is after rounding to single precision, so that the stored axes span the box exactly.
    const Mat3 axes = frame.cast<float>().cast<double>();
    const Mat3 inverse = axes.inverse();
    Vec3 lo = Vec3::Constant(std::numeric_limits<double>::infinity()), hi = -lo;
    for (const Vec3& p : points) {
      const Vec3 t = inverse * p;
      lo = lo.cwiseMin(t);
      hi = hi.cwiseMax(t);
    }
    const Vec3 middle = axes * (0.5 * (lo + hi));
    const Vec3f center = middle.cast<float>();
    // Moving the center by its rounding and the corners by theirs moves a coefficient by at most as much (the axes are
    // orthonormal up to 1e-7, which kFitSlack covers).
    const double grow = (middle - center.cast<double>()).norm() + 2 * copy_slack_;
    Vec3 half = 0.5 * (hi - lo);
    half = half * (1 + kFitSlack) + Vec3::Constant(grow * (1 + kFitSlack));
    std::array<int, 3> by_size{0, 1, 2};
    std::sort(by_size.begin(), by_size.end(), [&](int i, int j) { return half[i] > half[j]; });
    for (int i = 0; i < 3; ++i) {
      out.center[i] = center[i];
      out.half[i] = std::nextafter(static_cast<float>(half[by_size[i]]), std::numeric_limits<float>::infinity());
      for (int k = 0; k < 3; ++k) out.axis[i][k] = static_cast<float>(axes(k, by_size[i]));
    }
  }

  const PatchClusters& clusters_;
  double copy_slack_;
  std::vector<PatchNode>& nodes_;
  std::vector<std::uint32_t>& order_;
  std::vector<Vec3f> vertices_;                        ///< in the order of their first use
  std::vector<std::array<std::uint32_t, 3>> corners_;  ///< of each place in order_
  std::vector<std::uint32_t> first_;                   ///< of each place: vertices used before it
  std::vector<Vec3f> normals_;                         ///< of each cluster: sum over its faces, by area
  std::vector<Place> places_;                          ///< of all nodes
};

/// The face relative to `origin`; returns its largest distance from it, m.
double set_item(const TriangleMesh& mesh, std::uint32_t face, const Vec3& origin, PatchItem& t) {
  std::array<Vec3, 3> v;
  double farthest = 0;
  for (int k = 0; k < 3; ++k) {
    v[k] = mesh.vertices[mesh.triangles[face][k]] - origin;
    farthest = std::max(farthest, v[k].norm());
    t.v[k] = v[k].cast<float>();
  }
  const Vec3 n = (v[1] - v[0]).cross(v[2] - v[0]);
  const double length = n.norm();
  t.area = static_cast<float>(0.5 * length);
  t.normal = length > 0 ? Vec3f((n / length).cast<float>()) : Vec3f(Vec3f::Zero());
  // A sliver counts a little, or a set of slivers alone would have no frame.
  t.area = std::max(std::numeric_limits<float>::min(), t.area);
  t.area = std::max(t.area, 1e-6f * static_cast<float>((v[1] - v[0]).squaredNorm() + (v[2] - v[0]).squaredNorm()));
  return farthest;
}

}  // namespace

PatchTree::PatchTree(std::shared_ptr<const TriangleMesh> mesh) : mesh_(std::move(mesh)) {
  if (mesh_->triangles.empty()) throw Error(mesh_->name + ": no triangles to build a hierarchy over");
  Vec3 lo = corner(0, 0), hi = lo;
  for (const auto& t : mesh_->triangles) {
    for (std::uint32_t v : t) {
      lo = lo.cwiseMin(mesh_->vertices[v]);
      hi = hi.cwiseMax(mesh_->vertices[v]);
    }
  }
  origin_ = 0.5 * (lo + hi);
  std::vector<PatchItem> items(mesh_->triangles.size());
  std::vector<double> radius((items.size() + kFitAtOnce - 1) / kFitAtOnce, 0);
  const auto prepare = [&](int task) {
    const std::size_t from = static_cast<std::size_t>(task) * kFitAtOnce;
    for (std::size_t f = from; f < std::min(items.size(), from + kFitAtOnce); ++f)
      radius[static_cast<std::size_t>(task)] = std::max(
          radius[static_cast<std::size_t>(task)], set_item(*mesh_, static_cast<std::uint32_t>(f), origin_, items[f]));
  };
  parallel_for(static_cast<int>(radius.size()), 0, prepare, {});
  radius_ = *std::max_element(radius.begin(), radius.end());
  const PatchClusters clusters = cluster_patches(*mesh_, items);
  Layout(*mesh_, clusters, items, radius_, nodes_, order_);
}

PatchNode PatchTree::face_box(std::uint32_t face) const {
  std::array<Vec3, 3> v;
  for (int k = 0; k < 3; ++k) v[k] = corner(face, k) - origin_;
  // The rectangle along the longest edge has the least area.
  std::array<Vec3, 3> axis{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (int k = 0; k < 3; ++k) {
    const Vec3 e = v[(k + 1) % 3] - v[k];
    if (e.squaredNorm() > axis[0].squaredNorm()) axis[0] = e;
  }
  const double longest = axis[0].norm();
  axis[0] = longest > 0 ? Vec3(axis[0] / longest) : Vec3(Vec3::UnitX());
  axis[2] = (v[1] - v[0]).cross(v[2] - v[0]);
  if (!(axis[2].norm() > kFlatFace * longest * longest)) {
    axis[2] = axis[0].cross(std::abs(axis[0].x()) < 0.7 ? Vec3::UnitX() : Vec3::UnitY());
  }
  axis[1] = axis[2].cross(axis[0]).normalized();
  axis[2] = axis[0].cross(axis[1]);
  PatchNode out;
  Vec3 middle = Vec3::Zero();
  std::array<double, 3> half;
  for (int i = 0; i < 3; ++i) {
    const double a = axis[i].dot(v[0]), b = axis[i].dot(v[1]), c = axis[i].dot(v[2]);
    const double lo = std::min({a, b, c}), hi = std::max({a, b, c});
    half[i] = 0.5 * (hi - lo);
    middle += 0.5 * (lo + hi) * axis[i];
  }
  for (int i = 0; i < 3; ++i) out.center[i] = static_cast<float>(middle[i]);
  // Coefficients along the axes as stored differ from these by the rounding of the center and, since those axes are
  // orthonormal up to 2e-7 only, by that part of the extent.
  double grow = kFitSlack * longest;
  grow += (middle - out.center_vec()).norm() * (1 + kFitSlack);
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) out.axis[i][k] = static_cast<float>(axis[i][k]);
    out.half[i] = std::nextafter(static_cast<float>(half[i] + grow), std::numeric_limits<float>::infinity());
  }
  out.first = face;
  out.count = 1;
  return out;
}

std::size_t PatchTree::bytes() const {
  return nodes_.capacity() * sizeof(PatchNode) + order_.capacity() * sizeof(order_[0]);
}

}  // namespace tegotae
