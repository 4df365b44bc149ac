#include "feature/point_course.hpp"

#include <algorithm>
#include <cmath>

#include "feature/nearest_face.hpp"
#include "feature/simplex_distance.hpp"

namespace tegotae {
namespace {

constexpr std::uint32_t kRun = 4;  // places in a run of the lowest level

double distance_from_segment(const Vec3& p, const Vec3& middle, const Vec3& half) {
  const double along = (p - middle).dot(half), length = half.squaredNorm();
  return (p - middle - (length > 0 ? std::clamp(along / length, -1.0, 1.0) : 0.0) * half).norm();
}

/// The square of a lower bound of the distance from a segment to a box, m².
double squared_bound(const PatchNode& node, const Vec3& middle, const Vec3& half) {
  const Vec3 d = middle - node.center_vec();
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const Vec3 axis = node.axis_vec(i);
    const double out = std::max(0.0, std::abs(d.dot(axis)) - std::abs(half.dot(axis)) - double{node.half[i]});
    sum += out * out;
  }
  return kBoxRounding * sum;
}

/// Whether the plane of a triangle keeps it at `distance` from `p` or farther; false for one without area.
bool plane_keeps(const Vec3& p, const std::array<Vec3, 3>& t, double distance) {
  const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
  const double along = n.dot(p - t[0]), n2 = n.squaredNorm();
  return n2 > 0 && along * along >= distance * distance * n2;
}

bool nearer_face(const PatchTree& tree, const Vec3& p_F, std::uint32_t place, std::uint32_t face, NearPlace& best) {
  const std::array<Vec3, 3> t = {tree.corner(face, 0), tree.corner(face, 1), tree.corner(face, 2)};
  if (plane_keeps(p_F, t, best.distance)) return false;
  const double distance = std::sqrt(closest_points({1, {p_F}}, {3, t}).squared_distance);
  if (distance >= best.distance) return false;
  best.distance = distance;
  best.place = place;
  best.face = face;
  return true;
}

}  // namespace

void PointCourse::build() {
  runs_.clear();
  starts_.assign(1, 0);
  const auto count = static_cast<std::uint32_t>(places_.size());
  for (std::uint32_t begin = 0; begin < count; begin += kRun) {
    const std::uint32_t last = std::min(begin + kRun, count) - 1;
    Run r{0.5 * (places_[begin] + places_[last]), 0.5 * (places_[last] - places_[begin]), 0};
    for (std::uint32_t i = begin + 1; i < last; ++i)
      r.off = std::max(r.off, distance_from_segment(places_[i], r.middle, r.half));
    runs_.push_back(r);
  }
  starts_.push_back(static_cast<std::uint32_t>(runs_.size()));
  while (starts_.back() - starts_[starts_.size() - 2] > 1) {
    const std::uint32_t begin = starts_[starts_.size() - 2], end = starts_.back();
    for (std::uint32_t i = begin; i < end; i += 2) {
      const Run a = runs_[i], b = runs_[std::min(i + 1, end - 1)];
      const Vec3 from = a.middle - a.half, to = b.middle + b.half;
      Run r{0.5 * (from + to), 0.5 * (to - from), 0};
      // Segments are convex: a chord is no farther from another than its ends are.
      const double off_a = distance_from_segment(a.middle + a.half, r.middle, r.half) + a.off;
      const double off_b = distance_from_segment(b.middle - b.half, r.middle, r.half) + b.off;
      r.off = std::max(off_a, off_b);
      runs_.push_back(r);
    }
    starts_.push_back(static_cast<std::uint32_t>(runs_.size()));
  }
}

void PointCourse::consider(const PatchTree& tree, Open open, std::uint32_t node, double best) {
  const double squared = squared_bound(tree.nodes()[node], open.at.middle, open.at.half), most = best + open.at.off;
  if (squared >= most * most) return;
  open.bound = std::sqrt(squared) - open.at.off;
  open.node = node;
  open_.push_back(open);
}

void PointCourse::split_run(const PatchTree& tree, const Open& open, double best) {
  const std::uint32_t level = open.level - 1, count = starts_[level + 1] - starts_[level];
  for (std::uint32_t i = 2 * open.run; i < std::min(2 * open.run + 2, count); ++i) {
    const Run& r = run(level, i);
    consider(tree, {0, level, i, open.node, {R_ * r.middle + t_, R_ * r.half, r.off}}, open.node, best);
  }
}

/// Asks about the triangles of a leaf at the places of a run of the lowest level.
bool PointCourse::ask(const PatchTree& tree, const Open& open, NearPlace& best) const {
  const PatchNode& leaf = tree.nodes()[open.node];
  const std::uint32_t count = static_cast<std::uint32_t>(places_.size());
  const std::uint32_t begin = open.run * kRun, end = std::min(begin + kRun, count);
  bool any = false;
  for (std::uint32_t place = begin; place < end; ++place) {
    const Vec3 p = R_ * places_[place] + t_;
    if (squared_bound(leaf, p, Vec3::Zero()) >= best.distance * best.distance) continue;
    for (std::uint32_t i = 0; i < leaf.count; ++i)
      any |= nearer_face(tree, p + tree.origin(), place, tree.order()[leaf.first + i], best);
  }
  return any;
}

bool PointCourse::nearer(const PatchTree& tree, const Pose& X_FW, NearPlace& best) {
  if (places_.empty()) return false;
  R_ = X_FW.q.toRotationMatrix();
  t_ = X_FW.p - tree.origin();
  open_.clear();
  const auto top = static_cast<std::uint32_t>(starts_.size() - 2);
  const Run& all = runs_.back();
  consider(tree, {0, top, 0, 0, {R_ * all.middle + t_, R_ * all.half, all.off}}, 0, best.distance);
  bool any = false;
  while (!open_.empty()) {
    const Open open = open_.back();
    open_.pop_back();
    if (open.bound >= best.distance) continue;
    const PatchNode& node = tree.nodes()[open.node];
    if (open.level == 0 && node.leaf()) {
      any |= ask(tree, open, best);
      continue;
    }
    const bool long_run = open.at.half.norm() + open.at.off > double{node.half[0]};
    if (open.level > 0 && (node.leaf() || long_run)) {
      split_run(tree, open, best.distance);
    } else {
      consider(tree, open, node.first, best.distance);
      consider(tree, open, node.first + 1, best.distance);
    }
    // The nearer one of two is looked at first.
    const std::size_t n = open_.size();
    if (n > 1 && open_[n - 2].bound < open_[n - 1].bound) std::swap(open_[n - 2], open_[n - 1]);
  }
  return any;
}

bool PointCourse::nearer_there(const PatchTree& tree, const Pose& X_FW, std::uint32_t place, std::uint32_t face,
                               NearPlace& best) const {
  return nearer_face(tree, X_FW * places_[place], place, face, best);
}

}  // namespace tegotae
