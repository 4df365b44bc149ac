#include "narrowphase/patch_tree.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

constexpr std::uint32_t kNoCluster = 0xffffffffu;
/// Weight of the diameter against the thickness of a patch (design.md 4b): decides only where surfaces are flat.
constexpr double kDiameterWeight = 3e-4;
/// Relative enlargement of boxes: covers rounding of the fit (double) and of the stored half extents.
constexpr double kBoxSlack = 1e-6;
/// Rounding of the single-precision copies of the vertices, relative to the mesh's radius (half a step is 2^-25).
constexpr double kCopySlack = 1.0 / (1 << 24);
/// Faces thinner than this part of their longest edge have no plane to speak of.
constexpr double kFlatFace = 1e-9;
/// A round of merging that joins less than one cluster in so many goes on with pairs that are best for one side only.
constexpr std::size_t kSlowRound = 12;

using Vec3f = Eigen::Vector3f;

/// A triangle relative to the origin of the tree.
struct Item {
  std::array<Vec3f, 3> v;
  Vec3f normal;
  float area;
};

/// Area moments of a set of triangles, up to second order.
struct Moments {
  double w = 0;
  double x = 0, y = 0, z = 0;
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

  Moments& operator+=(const Moments& o) {
    w += o.w, x += o.x, y += o.y, z += o.z;
    xx += o.xx, yy += o.yy, zz += o.zz, xy += o.xy, xz += o.xz, yz += o.yz;
    return *this;
  }

  /// ∫ over the triangle, by the sum over its corners and its center: A/12 (Σ v vᵀ + 9 g gᵀ).
  static Moments of(const Item& t) {
    const double w = t.area, k = w / 12;
    const auto& [a, b, c] = t.v;
    const double sx = double{a.x()} + b.x() + c.x(), sy = double{a.y()} + b.y() + c.y(),
                 sz = double{a.z()} + b.z() + c.z();
    auto sum = [&, &p = a, &q = b, &r = c](int i, int j, double si, double sj) {
      return k * (double{p[i]} * p[j] + double{q[i]} * q[j] + double{r[i]} * r[j] + si * sj);
    };
    Moments m;
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

  /// Thickness + kDiameterWeight · diameter of the two sets together. A uniform slab of thickness t has the variance
  /// t²/12 across. The least eigenvalue is taken as det / (sum of the principal minors), exact for a thin set and a
  /// third for a ball.
  friend float joint_cost(const Moments& m, const Moments& o) {
    const double i = 1 / (m.w + o.w), mx = (m.x + o.x) * i, my = (m.y + o.y) * i, mz = (m.z + o.z) * i;
    const double a = (m.xx + o.xx) * i - mx * mx, b = (m.yy + o.yy) * i - my * my, c = (m.zz + o.zz) * i - mz * mz;
    const double d = (m.xy + o.xy) * i - mx * my, e = (m.xz + o.xz) * i - mx * mz, f = (m.yz + o.yz) * i - my * mz;
    const double minors = a * b - d * d + a * c - e * e + b * c - f * f;
    const double det = a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e);
    const double thin = minors > 0 ? std::max(det, 0.0) / minors : 0.0;
    return static_cast<float>(std::sqrt(12 * thin) + kDiameterWeight * std::sqrt(12 * std::max(a + b + c, 0.0)));
  }
};

/// Two clusters joined: `left` and `right` are clusters; a single face has none.
struct Join {
  std::uint32_t left = kNoCluster, right = kNoCluster;
  std::uint32_t faces = 1;
};

/// Clusters faces from the bottom by mutual best neighbors.
class Clustering {
 public:
  Clustering(const TriangleMesh& mesh, const std::vector<Item>& items) : joins_(items.size()) {
    joins_.reserve(2 * items.size());
    moments_.reserve(2 * items.size());
    for (const Item& t : items) moments_.push_back(Moments::of(t));
    active_.resize(items.size());
    std::iota(active_.begin(), active_.end(), 0u);
    link_faces(mesh);
    while (!links_.empty()) round();
    std::vector<std::uint32_t> roots = active_;
    root_ = join_apart(roots.data(), roots.data() + roots.size());
  }

  const std::vector<Join>& joins() const { return joins_; }
  const Moments& moments(std::uint32_t cluster) const { return moments_[cluster]; }
  std::uint32_t root() const { return root_; }

 private:
  /// Neighbors, as places in active_; a negative cost is not known yet.
  struct Link {
    std::uint32_t u, v;
    float cost;
  };

  /// Faces that share an edge: half-edges sorted by their lesser vertex, matched by the other one.
  void link_faces(const TriangleMesh& mesh) {
    std::vector<std::uint32_t> begin(mesh.vertices.size() + 1, 0);
    auto each = [&](auto f) {
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
          const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
          if (a != b) f(std::min(a, b), std::max(a, b), t);
        }
      }
    };
    each([&](std::uint32_t a, std::uint32_t, std::uint32_t) { ++begin[a + 1]; });
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    struct Half {
      std::uint32_t other, face;
    };
    std::vector<Half> half(begin.back());
    std::vector<std::uint32_t> place(begin.begin(), begin.end() - 1);
    each([&](std::uint32_t a, std::uint32_t b, std::uint32_t t) { half[place[a]++] = {b, t}; });
    links_.reserve(half.size() / 2 + 1);
    for (std::size_t a = 0; a + 1 < begin.size(); ++a) {
      const auto from = half.begin() + begin[a], to = half.begin() + begin[a + 1];
      std::sort(from, to,
                [](const Half& x, const Half& y) { return x.other != y.other ? x.other < y.other : x.face < y.face; });
      for (auto h = from; h != to && h + 1 != to; ++h) {
        if (h[0].other == h[1].other && h[0].face != h[1].face) links_.push_back({h[0].face, h[1].face, -1});
      }
    }
  }

  void round() {
    const std::size_t n = active_.size();
    best_.assign(n, kNoCluster);
    best_cost_.assign(n, std::numeric_limits<float>::infinity());
    best_key_.assign(n, 0);
    for (Link& l : links_) {
      if (l.cost < 0) l.cost = joint_cost(moments_[active_[l.u]], moments_[active_[l.v]]);
      // Regular meshes are full of ties; a scattered order breaks them in many places at once.
      const std::uint32_t key = (std::min(l.u, l.v) * 2654435761u) ^ (std::max(l.u, l.v) * 2246822519u);
      auto offer = [&](std::uint32_t u, std::uint32_t v) {
        if (l.cost > best_cost_[u] || (l.cost == best_cost_[u] && key <= best_key_[u])) return;
        best_cost_[u] = l.cost;
        best_key_[u] = key;
        best_[u] = v;
      };
      offer(l.u, l.v);
      offer(l.v, l.u);
    }
    renamed_.assign(n, kNoCluster);
    next_.clear();
    std::size_t joined = 0;
    for (std::uint32_t u = 0; u < n; ++u) {
      const std::uint32_t v = best_[u];
      if (v != kNoCluster && u < v && best_[v] == u) join(u, v), ++joined;
    }
    if (joined * kSlowRound < n) {
      for (std::uint32_t u = 0; u < n; ++u) {
        const std::uint32_t v = best_[u];
        if (v != kNoCluster && renamed_[u] == kNoCluster && renamed_[v] == kNoCluster) join(u, v);
      }
    }
    for (std::uint32_t u = 0; u < n; ++u) {
      if (renamed_[u] != kNoCluster) continue;
      renamed_[u] = static_cast<std::uint32_t>(next_.size()) | kKept;
      next_.push_back(active_[u]);
    }
    active_.swap(next_);
    relink();
  }

  /// Marks a place of the new round whose cluster is unchanged.
  static constexpr std::uint32_t kKept = 0x80000000u;

  void join(std::uint32_t u, std::uint32_t v) {
    renamed_[u] = renamed_[v] = static_cast<std::uint32_t>(next_.size());
    next_.push_back(add(active_[u], active_[v]));
  }

  std::uint32_t add(std::uint32_t left, std::uint32_t right) {
    joins_.push_back({left, right, joins_[left].faces + joins_[right].faces});
    Moments m = moments_[left];
    moments_.push_back(m += moments_[right]);
    return static_cast<std::uint32_t>(joins_.size() - 1);
  }

  /// Renames the ends of the links, drops those inside a cluster and all but one between two clusters.
  void relink() {
    std::size_t kept = 0;
    first_.assign(active_.size() + 1, 0);
    for (const Link& l : links_) {
      const std::uint32_t u = renamed_[l.u], v = renamed_[l.v];
      const std::uint32_t pu = u & ~kKept, pv = v & ~kKept;
      if (pu == pv) continue;
      links_[kept++] = {std::min(pu, pv), std::max(pu, pv), (u & v & kKept) ? l.cost : -1.0f};
      ++first_[std::min(pu, pv) + 1];
    }
    links_.resize(kept);
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    sorted_.resize(kept);
    for (const Link& l : links_) sorted_[first_[l.u]++] = l;
    seen_.assign(active_.size(), kNoCluster);
    kept = 0;
    for (const Link& l : sorted_) {
      if (seen_[l.v] == l.u) continue;
      seen_[l.v] = l.u;
      links_[kept++] = l;
    }
    links_.resize(kept);
  }

  /// Joins clusters that share no edge, by halving their centers along the longest side.
  std::uint32_t join_apart(std::uint32_t* begin, std::uint32_t* end) {
    if (end - begin == 1) return *begin;
    Vec3 lo = center(*begin), hi = lo;
    for (const std::uint32_t* c = begin; c != end; ++c) {
      lo = lo.cwiseMin(center(*c));
      hi = hi.cwiseMax(center(*c));
    }
    int axis = 0;
    (hi - lo).maxCoeff(&axis);
    std::uint32_t* middle = begin + (end - begin) / 2;
    std::nth_element(begin, middle, end, [&](std::uint32_t a, std::uint32_t b) {
      const double x = center(a)[axis], y = center(b)[axis];
      return x != y ? x < y : a < b;
    });
    const std::uint32_t left = join_apart(begin, middle), right = join_apart(middle, end);
    return add(left, right);
  }

  Vec3 center(std::uint32_t cluster) const {
    const Moments& m = moments_[cluster];
    return Vec3(m.x, m.y, m.z) / m.w;
  }

  std::vector<Join> joins_;
  std::vector<Moments> moments_;
  std::vector<std::uint32_t> active_, next_, renamed_, best_, best_key_, first_, seen_;
  std::vector<float> best_cost_;
  std::vector<Link> links_, sorted_;
  std::uint32_t root_ = 0;
};

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
/// Shapira, 1975). Reorders and drops points.
Point2 narrowest(std::vector<Point2>& points) {
  constexpr std::size_t kWorthFiltering = 24;
  // The long edges are the straight sides of a patch; the short ones of a round outline do not matter.
  constexpr std::size_t kLongestEdges = 8;
  if (points.size() > kWorthFiltering) drop_inner(points);
  std::sort(points.begin(), points.end(),
            [](const Point2& a, const Point2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  // Monotone chain (Andrew, 1979), lower and upper part one after the other.
  std::vector<Point2> hull(2 * points.size());
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
    const double dx = edge[i].x, dy = edge[i].y, length = std::sqrt(dx * dx + dy * dy);
    if (!(length > 0)) continue;
    const Point2& a = hull[0];
    double lo = 0, hi = 0, low = 0, high = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const double px = hull[k].x - a.x, py = hull[k].y - a.y;
      const double along = (px * dx + py * dy) / length, across = (py * dx - px * dy) / length;
      lo = std::min(lo, along);
      hi = std::max(hi, along);
      low = std::min(low, across);
      high = std::max(high, across);
    }
    high -= low;
    // A line has no area; any direction but its own would give it some.
    const double area = (hi - lo) * high + 1e-9 * (hi - lo + high) * (hi - lo + high);
    if (area < least) least = area, best = {dx / length, dy / length};
  }
  return best;
}

/// Lays the clusters out as nodes with fitted boxes.
class Layout {
 public:
  Layout(const Clustering& clusters, const std::vector<Item>& items, double radius, std::vector<PatchNode>& nodes,
         std::vector<std::uint32_t>& order)
      : clusters_(clusters), copy_slack_(radius * kCopySlack), nodes_(nodes), order_(order) {
    order_.reserve(items.size());
    const std::uint32_t root = clusters.root();
    collect(root);
    items_.reserve(items.size());
    for (std::uint32_t f : order_) items_.push_back(items[f]);
    nodes_.emplace_back();
    struct Place {
      std::uint32_t node, cluster, begin;
    };
    std::vector<Place> stack{{0, root, 0}};
    while (!stack.empty()) {
      const Place p = stack.back();
      stack.pop_back();
      const Join& j = clusters_.joins()[p.cluster];
      fit(p.node, p.cluster, p.begin, p.begin + j.faces);
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
      stack.push_back({child + 1, j.right, p.begin + clusters_.joins()[j.left].faces});
      stack.push_back({child, j.left, p.begin});
    }
  }

 private:
  /// Faces in the order of the leaves.
  void collect(std::uint32_t root) {
    std::vector<std::uint32_t> stack{root};
    while (!stack.empty()) {
      const std::uint32_t c = stack.back();
      stack.pop_back();
      const Join& j = clusters_.joins()[c];
      if (j.left == kNoCluster) {
        order_.push_back(c);
      } else {
        stack.push_back(j.right);
        stack.push_back(j.left);
      }
    }
  }

  void fit(std::uint32_t node, std::uint32_t cluster, std::uint32_t begin, std::uint32_t end) {
    const Moments& m = clusters_.moments(cluster);
    Vec3f mean = Vec3f::Zero();
    for (std::uint32_t i = begin; i < end; ++i) mean += items_[i].area * items_[i].normal;
    Eigen::SelfAdjointEigenSolver<Mat3> eigen;
    eigen.computeDirect(m.covariance());
    Mat3 frame = eigen.eigenvectors().rowwise().reverse();  // largest variance first
    if (!frame.allFinite() || std::abs(std::abs(frame.determinant()) - 1) > 1e-3) frame = Mat3::Identity();
    Vec3 normal = frame.col(2);
    const float length = mean.norm();
    // The mean normal gives the thinner box where the outline is ragged; it says nothing where normals cancel.
    if (length > 0.5f * static_cast<float>(m.w)) {
      const Vec3 other = (mean / length).cast<double>().normalized();
      if (thickness(begin, end, other) < thickness(begin, end, normal)) normal = other;
    }
    Vec3 u = normal.cross(std::abs(normal.x()) < 0.7 ? Vec3::UnitX() : Vec3::UnitY()).normalized();
    Vec3 v = normal.cross(u);
    points_.clear();
    for (std::uint32_t i = begin; i < end; ++i) {
      for (const Vec3f& c : items_[i].v) points_.push_back({c.cast<double>().dot(u), c.cast<double>().dot(v)});
    }
    const auto [x, y] = narrowest(points_);
    frame << (x * u + y * v).normalized(), (x * v - y * u).normalized(), normal;
    set_box(begin, end, frame, nodes_[node]);
  }

  float thickness(std::uint32_t begin, std::uint32_t end, const Vec3& direction) const {
    const Vec3f n = direction.cast<float>();
    float lo = std::numeric_limits<float>::infinity(), hi = -lo;
    for (std::uint32_t i = begin; i < end; ++i) {
      for (const Vec3f& v : items_[i].v) {
        const float x = n.dot(v);
        lo = std::min(lo, x);
        hi = std::max(hi, x);
      }
    }
    return hi - lo;
  }

  void set_box(std::uint32_t begin, std::uint32_t end, const Mat3& frame, PatchNode& out) const {
    // Fitted in the frame as it is after rounding to single precision, so that the stored axes span the box exactly.
    const Mat3 axes = frame.cast<float>().cast<double>();
    const Mat3 inverse = axes.inverse();
    Vec3 lo = Vec3::Constant(std::numeric_limits<double>::infinity()), hi = -lo;
    for (std::uint32_t i = begin; i < end; ++i) {
      for (const Vec3f& v : items_[i].v) {
        const Vec3 t = inverse * v.cast<double>();
        lo = lo.cwiseMin(t);
        hi = hi.cwiseMax(t);
      }
    }
    const Vec3 middle = axes * (0.5 * (lo + hi));
    const Vec3f center = middle.cast<float>();
    // Moving the center by its rounding and the corners by theirs moves a coefficient by at most as much (the axes are
    // orthonormal up to 1e-7, which kBoxSlack covers).
    const double grow = (middle - center.cast<double>()).norm() + 2 * copy_slack_;
    Vec3 half = 0.5 * (hi - lo);
    half = half * (1 + kBoxSlack) + Vec3::Constant(grow * (1 + kBoxSlack));
    std::array<int, 3> by_size{0, 1, 2};
    std::sort(by_size.begin(), by_size.end(), [&](int i, int j) { return half[i] > half[j]; });
    for (int i = 0; i < 3; ++i) {
      out.center[i] = center[i];
      out.half[i] = std::nextafter(static_cast<float>(half[by_size[i]]), std::numeric_limits<float>::infinity());
      for (int k = 0; k < 3; ++k) out.axis[i][k] = static_cast<float>(axes(k, by_size[i]));
    }
  }

  const Clustering& clusters_;
  double copy_slack_;
  std::vector<PatchNode>& nodes_;
  std::vector<std::uint32_t>& order_;
  std::vector<Item> items_;
  std::vector<Point2> points_;
};

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
  std::vector<Item> items(mesh_->triangles.size());
  for (std::uint32_t f = 0; f < items.size(); ++f) {
    Item& t = items[f];
    std::array<Vec3, 3> v;
    for (int k = 0; k < 3; ++k) {
      v[k] = corner(f, k) - origin_;
      radius_ = std::max(radius_, v[k].norm());
      t.v[k] = v[k].cast<float>();
    }
    const Vec3 n = (v[1] - v[0]).cross(v[2] - v[0]);
    const double length = n.norm();
    t.area = static_cast<float>(0.5 * length);
    t.normal = length > 0 ? Vec3f((n / length).cast<float>()) : Vec3f(Vec3f::Zero());
    // A sliver counts a little, or a set of slivers alone would have no frame.
    t.area = std::max(std::numeric_limits<float>::min(), t.area);
    t.area = std::max(t.area, 1e-6f * static_cast<float>((v[1] - v[0]).squaredNorm() + (v[2] - v[0]).squaredNorm()));
  }
  const Clustering clusters(*mesh_, items);
  Layout(clusters, items, radius_, nodes_, order_);
  nodes_.shrink_to_fit();
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
  double grow = kBoxSlack * longest;
  grow += (middle - out.center_vec()).norm() * (1 + kBoxSlack);
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
