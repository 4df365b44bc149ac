#include "narrowphase/near_front.hpp"

#include <algorithm>
#include <cmath>

#include "core/numbers.hpp"

namespace tegotae {
namespace {

// A front that has grown to so many times what it was, and so many pairs more, is built anew.
constexpr std::size_t kGrown = 2, kMore = 256;
// Edges whose sine is less have no common normal to speak of.
constexpr double kNearParallel = 1e-4;
// Directions between supporting corners that are tried after the axes of two boxes: where corners or edges of far
// boxes face each other the axes say little.
constexpr int kSupports = 3;
// Boxes are stored in single precision, their axes are unit vectors up to rounding.
constexpr double kArmRounding = 1 + 1e-5;

/// Half of what the box covers along a direction given in its tree's axes.
double extent(const PatchNode& node, const Vec3& n) {
  double sum = 0;
  for (int i = 0; i < 3; ++i) sum += double{node.half[i]} * std::abs(n.dot(node.axis_vec(i)));
  return sum;
}

/// The corner of the box that lies farthest along a direction, from its center.
Vec3 corner(const PatchNode& node, const Vec3& n) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    const Vec3 axis = node.axis_vec(i);
    sum += std::copysign(double{node.half[i]}, n.dot(axis)) * axis;
  }
  return sum;
}

/// The best of the 15 directions that can separate two boxes.
class BoxAxes {
 public:
  BoxAxes(const PatchNode& a, const PatchNode& b, const Mat3& R, const Vec3& between) : between_(between) {
    for (int i = 0; i < 3; ++i) {
      a_[i] = R * a.axis_vec(i);
      b_[i] = b.axis_vec(i);
      half_a_[i] = double{a.half[i]};
      half_b_[i] = double{b.half[i]};
    }
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) cosine_[i][j] = a_[i].dot(b_[j]);
  }

  /// Its unit normal from B to A; zero where none separates. Edges are not asked where faces are `enough`.
  Vec3 best(double enough) {
    for (int i = 0; i < 3; ++i) {
      double of_b = 0, of_a = 0;
      for (int j = 0; j < 3; ++j) {
        of_b += half_b_[j] * std::abs(cosine_[i][j]);
        of_a += half_a_[j] * std::abs(cosine_[j][i]);
      }
      offer(a_[i], half_a_[i] + of_b, 1);
      offer(b_[i], half_b_[i] + of_a, 1);
    }
    for (int i = 0; i < 3 && most_ < enough; ++i)
      for (int j = 0; j < 3; ++j) offer_edges(i, j);
    return best_;
  }

 private:
  void offer(const Vec3& direction, double extents, double length) {
    const double along = between_.dot(direction);
    const double gap = (std::abs(along) - extents) / length;
    if (gap <= most_) return;
    most_ = gap;
    best_ = (along < 0 ? -1 : 1) / length * direction;
  }
  void offer_edges(int i, int j) {
    const double squared = 1 - cosine_[i][j] * cosine_[i][j];
    if (!(squared > kNearParallel * kNearParallel)) return;
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    offer(a_[i].cross(b_[j]),
          half_a_[i1] * std::abs(cosine_[i2][j]) + half_a_[i2] * std::abs(cosine_[i1][j]) +
              half_b_[j1] * std::abs(cosine_[i][j2]) + half_b_[j2] * std::abs(cosine_[i][j1]),
          std::sqrt(squared));
  }

  Vec3 between_;
  std::array<Vec3, 3> a_, b_;
  std::array<double, 3> half_a_, half_b_;
  std::array<std::array<double, 3>, 3> cosine_;
  Vec3 best_ = Vec3::Zero();
  double most_ = -kInfinity;
};

}  // namespace

NearFront::NearFront(std::shared_ptr<const PatchTree> a, std::shared_ptr<const PatchTree> b)
    : a_(std::move(a)), b_(std::move(b)) {
  arms_.reserve(a_->nodes().size());
  for (const PatchNode& node : a_->nodes())
    arms_.push_back(kArmRounding * (node.center_vec().norm() + Vec3(node.half[0], node.half[1], node.half[2]).norm()));
}

void NearFront::place(const Pose& X_BA) {
  // No point of A goes farther than the origin of its tree and the turn about it take it.
  const Displacement d = placed_ ? displacement(X_, X_BA, a_->origin()) : Displacement();
  way_ += d.dp.norm();
  turn_ += d.dr.norm();
  X_ = X_BA;
  placed_ = true;
  R_ = X_BA.q.toRotationMatrix();
  t_ = X_BA * a_->origin() - b_->origin();
  if (front_.empty() || front_.size() > kGrown * built_ + kMore) {
    way_ = turn_ = 0;
    front_.assign(1, {0, 0, Vec3::Zero(), arms_[0], -kInfinity});
    built_ = 0;
  }
}

double NearFront::gap(const Pair& pair) const {
  const PatchNode &a = a_->nodes()[pair.a], &b = b_->nodes()[pair.b];
  const Vec3 in_a = R_.transpose() * pair.normal;
  return in_a.dot(a.center_vec()) + pair.normal.dot(t_ - b.center_vec()) - extent(a, in_a) - extent(b, pair.normal);
}

/// Looks for a direction along which the pair is farther apart, until it is `enough`; returns how far.
double NearFront::search(Pair& pair, double enough) const {
  const PatchNode &a = a_->nodes()[pair.a], &b = b_->nodes()[pair.b];
  const Vec3 between = R_ * a.center_vec() + t_ - b.center_vec();
  double best = gap(pair);
  const auto offer = [&](const Vec3& direction) {
    const double length = direction.norm();
    if (!(length > 0)) return false;
    const Pair other{pair.a, pair.b, direction / length, 0, 0};
    const double found = gap(other);
    if (found <= best) return false;
    best = found;
    pair.normal = other.normal;
    return true;
  };
  offer(BoxAxes(a, b, R_, between).best(enough));
  if (best < enough) offer(between);
  for (int i = 0; i < kSupports && best > 0 && best < enough; ++i)
    if (!offer(between + R_ * corner(a, R_.transpose() * -pair.normal) - corner(b, pair.normal))) break;
  return best;
}

void NearFront::keep(Pair pair, double gap) {
  pair.until = gap + gone(pair);
  front_.push_back(pair);
}

void NearFront::open(const Pair& pair, double gap, double bound, bool searched) {
  if (gap >= bound - kTolerance) return keep(pair, gap);
  open_.push_back({gap, searched, pair});
}

/// Takes out of the front what may be under the bound; asks about leaves at once.
void NearFront::collect(double& bound, LeafQuery& leaves) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < front_.size(); ++i) {
    Pair& pair = front_[i];
    if (bound > 0 && pair.until - gone(pair) < bound - kTolerance) {
      double now = gap(pair);
      if (now < bound - kTolerance) {
        const PatchNode &a = a_->nodes()[pair.a], &b = b_->nodes()[pair.b];
        if (!a.leaf() || !b.leaf()) {
          open_.push_back({now, false, pair});
          continue;
        }
        now = std::max(now, leaves.distance(a, b, pair.normal, bound));
      }
      pair.until = now + gone(pair);
    }
    front_[kept++] = pair;
  }
  front_.resize(kept);
}

void NearFront::split(const Open& top, double bound) {
  const PatchNode &a = a_->nodes()[top.pair.a], &b = b_->nodes()[top.pair.b];
  const bool of_a = b.leaf() || (!a.leaf() && a.half[0] + a.half[1] >= b.half[0] + b.half[1]);
  std::array<Open, 2> children;
  for (std::uint32_t k = 0; k < 2; ++k) {
    Pair pair = top.pair;
    (of_a ? pair.a : pair.b) = (of_a ? a : b).first + k;
    pair.arm = arms_[pair.a];
    children[k] = {std::max(top.gap, gap(pair)), false, pair};
  }
  if (children[0].gap < children[1].gap) std::swap(children[0], children[1]);
  for (const Open& child : children) open(child.pair, child.gap, bound, false);
}

void NearFront::query(const Pose& X_BA, double& bound, LeafQuery& leaves) {
  place(X_BA);
  open_.clear();
  collect(bound, leaves);
  while (!open_.empty()) {
    Open top = open_.back();
    open_.pop_back();
    if (!(bound > 0) || top.gap >= bound - kTolerance) {
      keep(top.pair, top.gap);
      continue;
    }
    const PatchNode &a = a_->nodes()[top.pair.a], &b = b_->nodes()[top.pair.b];
    if (a.leaf() && b.leaf()) {
      const double least = leaves.distance(a, b, top.pair.normal, bound);
      keep(top.pair, std::max(top.gap, least));
    } else if (!top.searched) {
      const double found = search(top.pair, bound - kTolerance);
      open(top.pair, std::max(top.gap, found), bound, true);
    } else {
      split(top, bound);
    }
  }
  if (built_ == 0) built_ = front_.size();
}

}  // namespace tegotae
