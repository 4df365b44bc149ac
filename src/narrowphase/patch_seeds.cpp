// Places from which contact features may be searched, out of the patch front.
#include <algorithm>
#include <cmath>

#include "narrowphase/patch_front.hpp"

namespace tegotae {
namespace {

/// Seeds are at least this part of A's reach apart, or their normals differ.
constexpr double kPlaceSpacing = 1.0 / 32;
/// Cosine between normals that count as alike (14°): the two walls of a groove give their own seeds.
constexpr double kLikeNormals = 0.97;
/// Near patches and places that are looked at, for each seed asked for: the nearest of them are given.
constexpr std::size_t kLooksPerSeed = 2;
/// Places where the faces are farther apart than this many times the reach give no seed. More than 1: a corner of two
/// curved patches is farther apart than their nearest points, by up to the thickness of both.
constexpr double kSeedReach = 4;

using Vec2 = Eigen::Vector2d;

/// A convex polygon in the plane, few corners.
struct Polygon {
  std::array<Vec2, 8> p;
  int n = 0;

  void add(const Vec2& x) {
    if (n < 8) p[n++] = x;
  }
  double area2() const {
    double a = 0;
    for (int i = 0; i < n; ++i) a += p[i].x() * p[(i + 1) % n].y() - p[i].y() * p[(i + 1) % n].x();
    return a;
  }
  void turn_left() {
    if (area2() < 0) std::reverse(p.begin(), p.begin() + n);
  }
  Vec2 middle() const {
    Vec2 m = Vec2::Zero();
    for (int i = 0; i < n; ++i) m += p[i];
    return m / n;
  }
};

/// The part of `a` inside `b` (Sutherland and Hodgman, 1974); both turn left.
Polygon overlap(Polygon a, const Polygon& b) {
  for (int k = 0; k < b.n && a.n > 0; ++k) {
    const Vec2 o = b.p[k], d = b.p[(k + 1) % b.n] - o;
    auto side = [&](const Vec2& x) { return d.x() * (x.y() - o.y()) - d.y() * (x.x() - o.x()); };
    Polygon cut;
    for (int i = 0; i < a.n; ++i) {
      const Vec2 &x = a.p[i], &y = a.p[(i + 1) % a.n];
      const double sx = side(x), sy = side(y);
      if (sx >= 0) cut.add(x);
      if ((sx > 0 && sy < 0) || (sx < 0 && sy > 0)) cut.add(x + (sx / (sx - sy)) * (y - x));
    }
    a = cut;
  }
  return a;
}

/// Two unit vectors that make a right-handed frame with n.
std::array<Vec3, 2> across(const Vec3& n) {
  const Vec3 u = n.cross(std::abs(n.x()) < 0.7 ? Vec3::UnitX() : Vec3::UnitY()).normalized();
  return {u, n.cross(u)};
}

/// Outline of a box seen along n: the rectangle of the two axes that are less aligned with n.
Polygon outline(const Vec3& center, const std::array<Vec3, 3>& half, const Vec3& n, const std::array<Vec3, 2>& e) {
  int along = 2;
  double most = 0;
  for (int i = 0; i < 3; ++i) {
    const double l = half[i].norm(), aligned = l > 0 ? std::abs(n.dot(half[i])) / l : 1;
    if (aligned > most) most = aligned, along = i;
  }
  auto flat = [&](const Vec3& x) { return Vec2(x.dot(e[0]), x.dot(e[1])); };
  const Vec2 c = flat(center), u = flat(half[(along + 1) % 3]), v = flat(half[(along + 2) % 3]);
  Polygon p;
  p.add(c - u - v);
  p.add(c + u - v);
  p.add(c + u + v);
  p.add(c - u + v);
  p.turn_left();
  return p;
}

Polygon outline(const std::array<Vec3, 3>& corners, const std::array<Vec3, 2>& e) {
  Polygon p;
  for (const Vec3& x : corners) p.add({x.dot(e[0]), x.dot(e[1])});
  p.turn_left();
  return p;
}

double box_distance2(const PatchNode& n, const Vec3& x) {
  const Vec3 d = x - n.center_vec();
  double s = 0;
  for (int i = 0; i < 3; ++i) {
    const double over = std::abs(d.dot(n.axis_vec(i))) - n.half[i];
    if (over > 0) s += over * over;
  }
  return s;
}

/// The point of the triangle nearest to x: of its plane, or of its edges.
Vec3 nearest_point(const std::array<Vec3, 3>& t, const Vec3& x) {
  const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
  bool inside = true;
  double least = std::numeric_limits<double>::infinity();
  Vec3 best = t[0];
  for (int i = 0; i < 3; ++i) {
    const Vec3 e = t[(i + 1) % 3] - t[i], d = x - t[i];
    inside = inside && n.cross(e).dot(d) >= 0;
    const double l = e.squaredNorm(), s = l > 0 ? std::min(std::max(e.dot(d) / l, 0.0), 1.0) : 0.0;
    const double distance2 = (d - s * e).squaredNorm();
    if (distance2 < least) least = distance2, best = t[i] + s * e;
  }
  const double area2 = n.squaredNorm();
  return inside && area2 > 0 ? Vec3(x - n.dot(x - t[0]) / area2 * n) : best;
}

/// The face under `node` near `x` (relative to the tree's origin): straight down to the nearer child, so not always the
/// nearest.
std::uint32_t face_near(const PatchTree& tree, std::uint32_t node, const Vec3& x) {
  const PatchNode* n = &tree.nodes()[node];
  while (!n->leaf()) {
    const PatchNode *left = &tree.nodes()[n->first], *right = left + 1;
    const double l = box_distance2(*left, x), r = box_distance2(*right, x);
    // Inside both: the one whose middle is nearer.
    const bool go_left =
        l != r ? l < r : (x - left->center_vec()).squaredNorm() <= (x - right->center_vec()).squaredNorm();
    n = go_left ? left : right;
  }
  std::uint32_t best = tree.order()[n->first];
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < n->count; ++i) {
    const std::uint32_t f = tree.order()[n->first + i];
    const Vec3& o = tree.origin();
    const std::array<Vec3, 3> t{tree.corner(f, 0) - o, tree.corner(f, 1) - o, tree.corner(f, 2) - o};
    const double d = (nearest_point(t, x) - x).squaredNorm();
    if (d < least) least = d, best = f;
  }
  return best;
}

}  // namespace

int PatchFront::contact_seeds(const Pose& X_BA, double reach, ContactSeed* out, int capacity) noexcept {
  const std::size_t most = std::min(static_cast<std::size_t>(std::max(capacity, 0)) * kLooksPerSeed, seeds_.capacity());
  set_sweep(X_BA, {});
  const LaneSweep sweep = lane_sweep();
  near_.clear();
  for (const Group* g : {&triangles_, &boxes_}) {
    const float* margin = margins(*g, sweep);
    for (std::uint32_t i = 0; i < g->count; ++i) {
      if (!(margin[i] < static_cast<float>(reach))) continue;
      near_.push_back({margin[i] + pool_[g->owner[i]].thickness, g->owner[i]});
    }
  }
  auto nearer = [](const Near& a, const Near& b) {
    return a.far_side != b.far_side ? a.far_side < b.far_side : a.id < b.id;
  };
  const std::size_t looked = std::min(near_.size(), most);
  std::partial_sort(near_.begin(), near_.begin() + looked, near_.end(), nearer);
  const double spacing = kPlaceSpacing * node_reach(a_->nodes()[0]), spacing2 = spacing * spacing;
  seeds_.clear();
  for (std::size_t i = 0; i < looked; ++i) {
    const PairNode& p = pool_[near_[i].id];
    const Vec3 n = plane(near_[i].id);
    std::array<Vec3, 8> corners;
    const int found = shared_corners(p, n, corners);
    for (int k = 0; k < found && seeds_.size() < most; ++k) {
      const Vec3 place = corners[k] + b_->origin();
      const bool taken = std::any_of(seeds_.begin(), seeds_.end(), [&](const ContactSeed& s) {
        return (s.place - place).squaredNorm() < spacing2 && s.n_BA.dot(n) > kLikeNormals;
      });
      if (taken) continue;
      const ContactSeed seed = seed_at(p, n, corners[k]);
      if (seed.distance < kSeedReach * reach) seeds_.push_back(seed);
    }
  }
  const std::size_t count = std::min(seeds_.size(), static_cast<std::size_t>(std::max(capacity, 0)));
  std::partial_sort_copy(seeds_.begin(), seeds_.end(), out, out + count,
                         [](const ContactSeed& a, const ContactSeed& b) { return a.distance < b.distance; });
  return static_cast<int>(count);
}

int PatchFront::shared_corners(const PairNode& p, const Vec3& n, std::array<Vec3, 8>& corners) const {
  const auto e = across(n);
  Polygon a, b;
  double height;  // of B's support along n
  if (faces(p)) {
    std::array<Vec3, 3> fa = face_a(p.a);
    const std::array<Vec3, 3> fb = face_b(p.b);
    for (Vec3& x : fa) x = sweep_.start.R * x + sweep_.start.t;
    a = outline(fa, e);
    b = outline(fb, e);
    height = std::max({n.dot(fb[0]), n.dot(fb[1]), n.dot(fb[2])});
  } else {
    PatchNode scratch_a, scratch_b;
    const PatchNode &na = box_a(p, scratch_a), &nb = box_b(p, scratch_b);
    std::array<Vec3, 3> ha, hb;
    height = n.dot(nb.center_vec());
    for (int i = 0; i < 3; ++i) {
      ha[i] = na.half[i] * (sweep_.start.R * na.axis_vec(i));
      hb[i] = nb.half[i] * nb.axis_vec(i);
      height += std::abs(n.dot(hb[i]));
    }
    a = outline(sweep_.start.R * node_center(na) + sweep_.start.t, ha, n, e);
    b = outline(nb.center_vec(), hb, n, e);
  }
  Polygon shared = overlap(a, b);
  if (shared.n == 0) {  // beside each other
    shared.add(0.5 * (a.middle() + b.middle()));
  }
  for (int k = 0; k < shared.n; ++k) corners[k] = shared.p[k].x() * e[0] + shared.p[k].y() * e[1] + height * n;
  return shared.n;
}

ContactSeed PatchFront::seed_at(const PairNode& p, const Vec3& n, const Vec3& place) const {
  const Vec3 in_a = sweep_.start.R.transpose() * (place - sweep_.start.t);
  ContactSeed seed{p.a, p.b, 0, n, place + b_->origin()};
  if (!p.face_a) seed.face_a = face_near(*a_, p.a, in_a - offset_a_);
  if (!p.face_b) seed.face_b = face_near(*b_, p.b, place);
  const Vec3 on_a = sweep_.start.R * nearest_point(face_a(seed.face_a), in_a) + sweep_.start.t;
  seed.distance = (on_a - nearest_point(face_b(seed.face_b), place)).norm();
  return seed;
}

}  // namespace tegotae
