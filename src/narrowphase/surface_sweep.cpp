

#include "narrowphase/surface_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/numbers.hpp"
#include "narrowphase/cell_slack.hpp"
#include "narrowphase/moving_plane.hpp"
#include "tegotae/core/clock.hpp"

namespace tegotae {
namespace {

/// Nodes of this level know what of B is beside them.
constexpr std::uint32_t kTopLevel = 2;
/// Blocks of A that are looked at first: so many, and one of so many.
constexpr std::uint32_t kSample = 32, kSampleShare = 100;
/// How exactly it is found where the motion ends (m), and the halvings that takes at most.
constexpr double kExact = 5e-7;
constexpr int kHalvings = 24;
/// Faces after which the clock is looked at.
constexpr std::uint32_t kFacesAtOnce = 4;
/// Boxes are grown by this share of the coordinates that they come from, in single precision.
constexpr float kBoxError = 1e-6F;
constexpr double kRadiusSlack = 1 + 1e-9;
/// What is free that blocks tell is taken a little shorter: they are looked at again.
constexpr double kShareKept = 0.999;
/// Where a block passes more blocks of B than so many, by a way longer than so many times its size, or more pairs of
/// faces than so many have to be asked exactly, the look goes on over half of the motion: all the way past surfaces
/// that lie beside each other, or around in each other, takes seconds for a large part.
constexpr std::uint32_t kManyPassed = 64, kManyAsked = 48;
constexpr double kPassedWay = 4, kAskedWay = 1;
/// What whole blocks leave of a motion is enough where it is so much of what faces have left.
constexpr double kEnough = 0.85;
/// Blocks that may be looked at face by face before all are: so many, and one for so many of A's.
constexpr std::uint32_t kFewBlocks = 32, kBlocksShare = 24;

}  // namespace

SurfaceSweep::Surface::Surface(const PatchTree& tree) : blocks(tree), slabs(tree, blocks) {
  lanes.reserve(blocks.count());
  for (std::uint32_t block = 0; block < blocks.count(); ++block) lanes.emplace_back(tree, blocks, block);
}

SurfaceSweep::SurfaceSweep(std::shared_ptr<const PatchTree> a, const Vec3& center,
                           const std::vector<CellFront::FixedPart>& fixed, std::shared_ptr<const Facing> facing,
                           std::shared_ptr<const Backing> backing, std::uint32_t blocking)
    : a_(std::move(a)),
      facing_(std::move(facing)),
      backing_(std::move(backing)),
      surface_of_a_(std::make_shared<Surface>(*a_)),
      center_(center),
      reach_(a_->radius() + (a_->origin() - center).norm()) {
  if (facing_) facing_cones_ = cones_of(facing_->faces());
  if (backing_) {
    backing_cones_ = cones_of(backing_->faces());
    for (const Backing::Side side : {Backing::Side::plus, Backing::Side::minus})
      if (const auto& walls = backing_->walls(side))
        walls_[static_cast<std::size_t>(side)] = std::make_shared<Surface>(*walls);
    reach_ += backing_->drawn(Backing::Side::plus).norm();
  }
  std::map<const PatchTree*, std::shared_ptr<const Surface>> known = {{a_.get(), surface_of_a_}};
  for (const CellFront::FixedPart& part : fixed) {
    auto& own = known[part.tree.get()];
    if (!own && part.tree->mesh().triangles.size() <= kMostFaces) own = std::make_shared<Surface>(*part.tree);
    parts_.push_back({part.tree, own, part.pose});
  }
  near_.reserve(fixed.size());
  outside_.assign(fixed.size(), false);
  blocking_.reserve(blocking);
}

SurfaceSweep::Cones SurfaceSweep::cones_of(const std::vector<NormalCone>& faces) const {
  Cones cones{&faces, {}};
  const FaceBlocks& blocks = surface_of_a_->blocks;
  std::uint32_t each = 1;
  for (std::uint32_t level = 0; level < surface_of_a_->slabs.levels(); ++level, each *= FaceBlocks::kFan) {
    cones.nodes.emplace_back();
    for (std::uint32_t first = 0; first < blocks.count(); first += each) {
      std::vector<std::uint32_t> under;
      for (std::uint32_t block = first; block < std::min(first + each, blocks.count()); ++block)
        for (std::uint32_t k = 0; k < blocks.faces(block); ++k) under.push_back(blocks.face(block, k));
      cones.nodes.back().push_back(NormalCone::around(faces, under));
    }
  }
  return cones;
}

void SurfaceSweep::begin(const Pose& X, const Displacement& d, const std::vector<std::uint32_t>& near,
                         const std::vector<bool>& outside, const SweepAim& aim) noexcept {
  X_ = X;
  d_ = d;
  near_.assign(near.begin(), near.end());
  for (std::size_t i = 0; i < near.size(); ++i) outside_[i] = facing_ && outside[i];
  clearance_ = aim.clearance;
  kept_ = std::max(aim.kept, aim.clearance);
  worth_ = aim.worth / (d.dp.norm() + reach_ * d.dr.norm());
  drawn_ = backing_ ? aim.drawn : std::nullopt;
  under_way_ = true;
  start_looks();
}

void SurfaceSweep::start_looks() {
  blocking_.clear();
  share_ = 1;
  ended_early_ = halved_ = false;
  searched_blocks_ = 0;
  last_plane_ = {Vec3::Zero(), Vec3::Zero()};
  if (!near_.empty()) start_look(Look::sample);
}

bool SurfaceSweep::go_on(std::int64_t deadline_ns) noexcept {
  while (under_way_) {
    if (share_ <= 0 || near_.empty()) {
      under_way_ = false;
    } else if (face_ < faces_) {
      look_at_face(face_++);
      if (face_ % kFacesAtOnce != 0) continue;
    } else if (!next_beside() && !(by_nodes() ? next_node() : next_block()) && !next_part()) {
      under_way_ = false;
    }
    if (past(deadline_ns)) break;
  }
  return !under_way_;
}

void SurfaceSweep::start_look(Look look) {
  // Of what was drawn, blocks have told as much as faces would.
  const bool drawn_again = drawn_ && !(look_ == Look::blocks && look == Look::faces);
  look_ = look;
  start_layer(drawn_again ? Layer::walls : Layer::faces);
}

void SurfaceSweep::start_layer(Layer layer) {
  layer_ = layer;
  tree_a_ = a_.get();
  surface_a_ = surface_of_a_.get();
  if (layer == Layer::walls) {
    tree_a_ = backing_->walls(*drawn_).get();
    surface_a_ = walls_[static_cast<std::size_t>(*drawn_)].get();
    if (surface_a_ == nullptr) return start_layer(Layer::moved_faces);
  }
  shift_a_ = layer == Layer::moved_faces ? backing_->drawn(*drawn_) : Vec3(Vec3::Zero());
  offset_a_ = tree_a_->origin() + shift_a_ - center_;
  at_ = 0;
  face_ = faces_ = 0;
  start_part();
}

/// Begins with the part `at_`, at A's root.
void SurfaceSweep::start_part() {
  sampled_ = tops_count_ = 0;
  stack_[0] = {surface_a_->blocks.levels() - 1, 0};
  stacked_ = 1;
  set_share(share_);
}

/// The motion up to `share` of it, as the part sees it.
Sweep SurfaceSweep::sweep_by(double share, double clearance) const {
  const Part& B = part();
  const Quat q = B.pose.q.conjugate();
  return Sweep(B.pose.inverse() * X_, {q * (share * d_.dp), q * (share * d_.dr)}, center_, *B.tree, reach_, clearance);
}

void SurfaceSweep::set_share(double share) {
  share_ = share;
  sweep_ = sweep_by(share, clearance_);
  // Of both readings of the path; see Bulge. What is kept from a longer motion is kept from the first part of it: its
  // readings are nearer to each other.
  passing_ = PassingPoints::seen_from_a(sweep_);
  floor_ = sweep_.floor + 0.125 * kUnitSlack * sweep_.theta2 * (reach_ + sweep_.center_distance);
}

/// The next part, or the first one once more. False when all is done.
bool SurfaceSweep::next_part() {
  if (++at_ < near_.size()) {
    start_part();
    return true;
  }
  if (layer_ != Layer::faces) {
    start_layer(layer_ == Layer::walls ? Layer::moved_faces : Layer::faces);
    return true;
  }
  if (look_ != Look::sample) {
    if (ended_early_) blocking_.clear();
    return false;
  }
  sampled_share_ = share_;
  start_look(std::isfinite(worth_) ? Look::blocks : Look::faces);
  return true;
}

/// Finds the next block of A beside which there may be something of B. False when all were looked at.
bool SurfaceSweep::next_block() {
  if (look_ == Look::sample) {
    const std::uint32_t blocks = surface_a_->blocks.count();
    const std::uint32_t stride = std::max(1U, blocks / (kSample + blocks / kSampleShare));
    const std::uint32_t block = stride / 2 + stride * sampled_;
    if (block >= blocks) return false;
    ++sampled_;
    if (!all_recede(block)) place(block);
    return true;
  }
  while (stacked_ > 0) {
    const Node node = stack_[--stacked_];
    if (recedes(node)) continue;
    walk_beside(node, 0);
    if (walk_.next(found_.data(), 1) == 0) continue;
    if (node.level == 0) {
      if (all_recede(node.index)) continue;
      place(node.index);
      return true;
    }
    push_below(node);
  }
  return false;
}

/// Walks over what of B is beside A's node. What is under one goes on from what was found for it.
void SurfaceSweep::walk_beside(const Node& node, std::uint32_t level) {
  const AxisBox box = swept(surface_a_->blocks.box(node.level, node.index));
  if (node.level >= kTopLevel) tops_count_ = 0;
  if (node.level == kTopLevel && surface_b().blocks.levels() > kTopLevel) {
    walk_.start(surface_b().blocks, box, kTopLevel);
    tops_count_ = walk_.next(tops_.data(), BlockWalk::kMostTops);
    if (tops_count_ == BlockWalk::kMostTops) tops_count_ = 0;
  }
  walk(box, level);
}

void SurfaceSweep::walk(const AxisBox& box, std::uint32_t level) {
  if (tops_count_ > 0) {
    walk_.start_under(tops_.data(), tops_count_, kTopLevel, surface_b().blocks, box, level);
  } else {
    walk_.start(surface_b().blocks, box, level);
  }
}

void SurfaceSweep::push_below(const Node& node) {
  const std::uint32_t below = surface_a_->blocks.nodes(node.level - 1), first = node.index * FaceBlocks::kFan;
  for (std::uint32_t i = first; i < std::min(first + FaceBlocks::kFan, below); ++i)
    stack_[stacked_++] = {node.level - 1, i};
}

/// Looks at the next node of A's hierarchy as a whole; a block's faces one by one where that is not enough. False when
/// there is none.
bool SurfaceSweep::next_node() {
  if (stacked_ == 0) return false;
  const Node node = stack_[--stacked_];
  if (recedes(node)) return true;
  const double apart = node_apart_for(node);
  if (apart == 1 || (node.level == 0 && all_recede(node.index))) return true;
  if (is_enough(apart)) {
    // Over a shorter way from here on; this one once more.
    set_share(kShareKept * apart * share_);
    ended_early_ = true;
    ++stacked_;
  } else if (node.level > 0) {
    push_below(node);
  } else if (layer_ != Layer::faces || look_ == Look::faces || may_search()) {
    ++searched_blocks_;
    place(node.index);
  } else {
    // Most would be looked at, and so may all be, for all of the way.
    share_ = sampled_share_;
    ended_early_ = halved_;
    start_look(Look::faces);
  }
  return true;
}

/// Whether the motion may end so early as whole blocks tell.
bool SurfaceSweep::is_enough(double apart) const {
  const double kept = kShareKept * apart * share_;
  if (look_ != Look::blocks || layer_ != Layer::faces) return false;
  return kept >= kEnough * sampled_share_ || (!may_search() && kept >= worth_);
}

/// Whether few blocks were looked at face by face until now.
bool SurfaceSweep::may_search() const {
  return searched_blocks_ < kFewBlocks + surface_a_->blocks.count() / kBlocksShare;
}

/// The share of the motion in which all faces under A's node are apart from B, or less.
double SurfaceSweep::node_apart_for(const Node& node) {
  const std::uint32_t level = std::min(node.level, surface_b().blocks.levels() - 1);
  walk_beside(node, level);
  const bool flat = node.level < surface_a_->slabs.levels() && level < surface_b().slabs.levels();
  MovedSlab slab;
  if (flat) slab = moved(surface_a_->slabs.slab(node.level, node.index));
  double apart = 1;
  for (std::uint32_t count = kBeside; count == kBeside;) {
    count = walk_.next(found_.data(), kBeside);
    for (std::uint32_t i = 0; i < count; ++i) {
      if (!flat) return 0;
      const double share = apart_for(slab, surface_b().slabs.slab(level, found_[i]), floor_);
      if (share == 1) continue;
      if (node.level > 0 || !apart_from_faces(slab, found_[i])) apart = std::min(apart, share);
      if (!is_enough(apart)) return 0;
    }
  }
  return apart;
}

/// Whether the faces of a block of B are each apart from what A's block is in.
bool SurfaceSweep::apart_from_faces(const MovedSlab& slab, std::uint32_t block) {
  const FaceLanes& b = surface_b().lanes[block];
  const Vec3 middle = 0.5 * (slab.from + slab.to);
  return not_kept_apart(slab.corners(middle), b, middle - b.origin, floor_) == 0;
}

MovedSlab SurfaceSweep::moved(const Slab& slab) const {
  MovedSlab out;
  const Vec3 center = slab.center + offset_a_;
  const Mat3 axes = slab.axes * slab.half.asDiagonal();
  out.from = sweep_.start.R * center + sweep_.start.t;
  out.to = sweep_.end.R * center + sweep_.end.t;
  out.from_axes = sweep_.start.R * axes;
  out.to_axes = sweep_.end.R * axes;
  out.axes = sweep_.start.R * slab.axes;
  return out;
}

/// What all points of a box of A pass, in B's axes.
AxisBox SurfaceSweep::swept(const AxisBox& box) const {
  Vec3 middle, half;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    middle[axis] = 0.5 * (double{box.low[i]} + double{box.high[i]});
    half[axis] = 0.5 * (double{box.high[i]} - double{box.low[i]});
  }
  AxisBox out = AxisBox::empty();
  for (const Placement* at : {&sweep_.start, &sweep_.end}) {
    const Vec3 to = at->R * (middle + offset_a_) + at->t;
    const Vec3 reach = at->R.cwiseAbs() * half + Vec3::Constant(floor_ + kBoxError * (to.norm() + half.norm()));
    out.add(to - reach, to + reach);
  }
  return out;
}

/// Whether all faces under A's node recede from the part, by what is known of them together.
bool SurfaceSweep::recedes(const Node& node) const {
  if (!may_recede() || node.level >= cones().nodes.size()) return false;
  const Slab& slab = surface_a_->slabs.slab(node.level, node.index);
  return passing_.recedes(seen(cones().nodes[node.level][node.index]), slab.center + offset_a_,
                          kRadiusSlack * slab.half.norm());
}

/// Whether no face of A's block recedes, by what is known of them together.
bool SurfaceSweep::none_recedes(std::uint32_t block) const {
  const Slab& slab = surface_a_->slabs.slab(0, block);
  return passing_.meets(seen(cones().nodes[0][block]), slab.center + offset_a_);
}

/// Whether all faces of A's block recede from the part, and so need not be looked at.
bool SurfaceSweep::all_recede(std::uint32_t block) {
  skipped_ = 0;
  if (!may_recede() || none_recedes(block)) return false;
  const std::uint32_t faces = surface_a_->blocks.faces(block);
  for (std::uint32_t k = 0; k < faces; ++k) {
    const std::uint32_t face = surface_a_->blocks.face(block, k);
    const Vec3 &p = a_->corner(face, 0), &q = a_->corner(face, 1), &r = a_->corner(face, 2);
    const Vec3 middle = (p + q + r) / 3;
    const double radius =
        std::sqrt(std::max({(p - middle).squaredNorm(), (q - middle).squaredNorm(), (r - middle).squaredNorm()}));
    if (passing_.recedes(seen((*cones().faces)[face]), middle - center_, kRadiusSlack * radius)) skipped_ |= 1U << k;
  }
  return skipped_ == (1U << faces) - 1;
}

/// A's block where it is, and where it goes.
void SurfaceSweep::place(std::uint32_t block) {
  block_ = block;
  faces_ = surface_a_->blocks.faces(block);
  const FaceLanes& faces = surface_a_->lanes[block];
  const Vec3 origin = faces.origin + offset_a_;
  Placement start = sweep_.start, end = sweep_.end;
  start.t += start.R * origin;
  end.t += end.R * origin;
  const double way = (end.t - start.t).norm();
  middle_ = 0.5 * (start.t + end.t);
  start.t -= middle_;
  end.t -= middle_;
  moved_.set(faces, start, end);
  AxisBox box = AxisBox::empty();
  for (std::uint32_t k = 0; k < faces_; ++k)
    if ((skipped_ >> k & 1) == 0) box.add(face_box(k));
  for (std::size_t i = 0; i < 3; ++i) {
    const auto at = static_cast<float>(middle_[static_cast<Eigen::Index>(i)]);
    const float slack = static_cast<float>(floor_) + kBoxError * (std::abs(at) + 4 * moved_.size);
    box.low[i] += at - slack;
    box.high[i] += at + slack;
  }
  walk(box, 0);
  beside_.clear();
  face_ = faces_;
  passed_ = asked_ = 0;
  sizes_passed_ = way / faces.size;
}

AxisBox SurfaceSweep::face_box(std::uint32_t k) const {
  return {{moved_.low[0][k], moved_.low[1][k], moved_.low[2][k]},
          {moved_.high[0][k], moved_.high[1][k], moved_.high[2][k]}};
}

/// The next blocks of B beside that of A, for all faces of it.
bool SurfaceSweep::next_beside() {
  if (faces_ == 0) return false;
  const std::uint32_t count = walk_.next(found_.data(), kBeside);
  passed_ += count;
  if (passed_ > kManyPassed && sizes_passed_ > kPassedWay) {
    look_less_far();
    return true;
  }
  beside_.set(surface_b().blocks, surface_b().lanes, found_.data(), count, moved_, middle_, floor_);
  face_ = 0;
  if (count == 0) face_ = faces_ = 0;
  return count > 0;
}

/// Half as far as until now, from this block on.
void SurfaceSweep::look_less_far() {
  set_share(0.5 * share_);
  sampled_share_ = std::min(sampled_share_, share_);
  ended_early_ = halved_ = true;
  place(block_);
}

void SurfaceSweep::look_at_face(std::uint32_t k) {
  if ((skipped_ >> k & 1) != 0) return;
  for (std::uint32_t at = 0; at < beside_.count(); ++at) {
    const std::uint32_t open = beside_.next_not_kept_apart(moved_, k, across_, at);
    if (open != 0 && !look_at_pairs(k, found_[at], open)) return;
  }
}

/// Face `k` of A's block and those of a block of B that may be near. Whether the motion goes on as far as before.
bool SurfaceSweep::look_at_pairs(std::uint32_t k, std::uint32_t block, std::uint32_t open) {
  const FaceLanes& b = surface_b().lanes[block];
  for (std::uint32_t lane = 0; open != 0; ++lane, open >>= 1) {
    if ((open & 1) == 0 || lane >= surface_b().blocks.faces(block)) continue;
    if (edges_keep_apart(moved_, k, b, lane, middle_ - b.origin, floor_, across_)) continue;
    const std::uint32_t face = surface_a_->blocks.face(block_, k), face_b = surface_b().blocks.face(block, lane);
    const Faces faces = faces_of(face, face_b);
    if (keeps_apart(faces)) {
      if (++asked_ <= kManyAsked || sizes_passed_ < kAskedWay) continue;
      look_less_far();
      return false;
    }
    if (layer_ != Layer::faces) {
      // Not solid, then.
      drawn_.reset();
      start_looks();
      return false;
    }
    if (blocking_.size() == blocking_.capacity()) blocking_.erase(blocking_.begin());
    blocking_.push_back({near_[at_], face, face_b});
    meet(faces);
    sampled_share_ = std::min(sampled_share_, share_);
    ended_early_ = halved_ = false;
    // Over a shorter way from here on.
    place(block_);
    return false;
  }
  return true;
}

SurfaceSweep::Faces SurfaceSweep::faces_of(std::uint32_t face, std::uint32_t face_b) const {
  Faces out;
  for (int c = 0; c < 3; ++c) {
    out.a[c] = tree_a_->corner(face, c) + shift_a_ - center_;
    out.b[c] = part().tree->corner(face_b, c) - part().tree->origin();
    out.reach = std::max(out.reach, out.a[c].norm());
  }
  return out;
}

bool SurfaceSweep::keeps_apart(const Faces& faces) {
  MovingPlane plane = last_plane_.n0.isZero(0) ? MovingPlane{Vec3::UnitX(), Vec3::UnitX()} : last_plane_;
  if (!separate_triangles(faces.a, faces.b, sweep_, faces.reach, nullptr, plane)) return false;
  last_plane_ = plane;
  return true;
}

/// Something is in the way: the motion ends before it.
void SurfaceSweep::meet(const Faces& faces) {
  double until = free_until(faces, look_ == Look::sample ? kept_ : clearance_);
  // It was nearer at the start.
  if (until == 0 && look_ == Look::sample) until = free_until(faces, clearance_);
  set_share(until);
}

double SurfaceSweep::free_until(const Faces& faces, double clearance) const {
  const double length = d_.dp.norm() + reach_ * d_.dr.norm();
  const double start_floor = sweep_.start_floor;
  double free = 0, met = share_;
  for (int i = 0; i < kHalvings && (met - free) * length > kExact; ++i) {
    const double s = 0.5 * (free + met);
    Sweep sweep = sweep_by(s, clearance);
    sweep.start_floor = start_floor;
    MovingPlane plane{Vec3::UnitX(), Vec3::UnitX()};
    (separate_triangles(faces.a, faces.b, sweep, faces.reach, nullptr, plane) ? free : met) = s;
  }
  return free;
}

}  // namespace tegotae
