#include "narrowphase/sweep_worker.hpp"

#include <algorithm>
#include <cmath>

#include "core/numbers.hpp"
#include "narrowphase/cell_slack.hpp"
#include "narrowphase/moving_plane.hpp"
#include "tegotae/core/clock.hpp"

namespace tegotae {
namespace {

/// Fewer pieces are few.
constexpr std::uint32_t kFewPieces = 16;
/// Blocks of A that are looked at first: so many, and one of so many.
constexpr std::uint32_t kSample = 32, kSampleShare = 100;
/// How exactly it is found where the motion ends (m), and the halvings that takes at most.
constexpr double kExact = 5e-7;
constexpr int kHalvings = 24;
/// Faces after which the clock is looked at.
constexpr std::uint32_t kFacesAtOnce = 4;
constexpr double kRadiusSlack = 1 + 1e-9;
/// Where a block passes more blocks of B than so many, by a way longer than so many times its size, or more pairs of
/// faces than so many have to be asked exactly, the look goes on over half of the motion: all the way past surfaces
/// that lie beside each other, or around in each other, takes seconds for a large part.
constexpr std::uint32_t kManyPassed = 64, kManyAsked = 48;
constexpr double kPassedWay = 4, kAskedWay = 1;
/// Of pieces at most.
constexpr std::uint32_t kPieceLevel = 2;

/// One less where there would be few.
std::uint32_t piece_level(const FaceBlocks& blocks) {
  const std::uint32_t level = std::min(kPieceLevel, blocks.levels() - 1);
  return level > 0 && blocks.nodes(level) < kFewPieces ? level - 1 : level;
}

std::uint32_t sample_stride(const FaceBlocks& blocks) {
  return std::max(1U, blocks.count() / (kSample + blocks.count() / kSampleShare));
}

std::uint32_t pieces_of(const FaceBlocks& blocks, SweepTask::Look look) {
  if (look != SweepTask::Look::sample) return blocks.nodes(piece_level(blocks));
  const std::uint32_t stride = sample_stride(blocks);
  return (blocks.count() - stride / 2 + stride - 1) / stride;
}

}  // namespace

std::uint32_t SweepWorker::pieces(const SweepModel& model, const SweepTask::Question& question) {
  const bool walls = question.layer == Layer::walls;
  return pieces_of((walls ? model.walls[static_cast<std::size_t>(*question.drawn)] : model.surface_of_a)->blocks,
                   question.look);
}

std::size_t SweepWorker::most_pieces(const SweepModel& model) {
  std::uint32_t most = 0;
  for (const auto& surface : {model.surface_of_a, model.walls[0], model.walls[1]})
    for (const Look look : {Look::sample, Look::blocks})
      if (surface) most = std::max(most, pieces_of(surface->blocks, look));
  return most;
}

bool SweepWorker::begin(SweepTask& task) {
  task_ = &task;
  id_ = task.id();
  piece_.reset();
  stacked_ = 0;
  for (Tops& tops : tops_) tops.count = 0;
  blocks_asked_ = blocks_told_ = 0;
  face_ = faces_ = 0;
  last_plane_ = {Vec3::Zero(), Vec3::Zero()};
  const bool walls = question().layer == Layer::walls;
  tree_a_ = walls ? model_->backing->walls(*question().drawn).get() : model_->a.get();
  surface_a_ = walls ? model_->walls[static_cast<std::size_t>(*question().drawn)].get() : model_->surface_of_a.get();
  shift_a_ = question().layer == Layer::moved_faces ? model_->backing->drawn(*question().drawn) : Vec3(Vec3::Zero());
  offset_a_ = tree_a_->origin() + shift_a_ - model_->center;
  set_share(task.end.value().share);
  const Node root = {surface_a_->blocks.levels() - 1, 0};
  if (recedes(root)) return false;
  walk(swept(surface_a_->blocks.box(root.level, root.index)), 0);
  return walk_.next(found_.data(), 1) != 0;
}

bool SweepWorker::work(SweepTask& task, std::int64_t deadline_ns) {
  if (task_ != &task || id_ != task.id()) begin(task);
  while (!task.is_over()) {
    if (face_ < faces_) {
      look_at_face(face_++);
      if (face_ % kFacesAtOnce != 0) continue;
    } else if (!next_beside() && !next_in_piece()) {
      if (piece_) task.finish(*piece_);
      piece_ = task.take();
      if (!piece_) return true;
      start_piece();
    }
    if (past(deadline_ns)) return false;
  }
  return true;
}

void SweepWorker::start_piece() {
  for (Tops& tops : tops_) tops.count = 0;
  blocks_asked_ /= 2;
  blocks_told_ /= 2;
  if (question().look != Look::sample) {
    stack_[0] = {piece_level(surface_a_->blocks), *piece_};
    stacked_ = 1;
    return;
  }
  const std::uint32_t stride = sample_stride(surface_a_->blocks);
  const std::uint32_t block = stride / 2 + stride * *piece_;
  refresh_share();
  const Node node = {0, block};
  if (!recedes(node) && node_apart_for(node) < 1 && !all_recede(block)) place(block);
}

/// Goes on with a piece. False when it is done, by this thread or another.
bool SweepWorker::next_in_piece() {
  if (!piece_ || task_->is_done(*piece_)) stacked_ = 0;
  if (stacked_ == 0) return false;
  refresh_share();
  if (by_nodes()) {
    next_node();
  } else {
    next_block();
  }
  return true;
}

/// Over as short a way from here on as others have found.
void SweepWorker::refresh_share() {
  if (const double share = task_->end.value().share; share < share_) set_share(share);
}

/// The motion up to `share` of it, as the part sees it.
Sweep SweepWorker::sweep_by(double share, double clearance) const {
  const SweepModel::Part& B = part();
  const Quat q = B.pose.q.conjugate();
  const Displacement& d = question().d;
  return Sweep(B.pose.inverse() * question().X, {q * (share * d.dp), q * (share * d.dr)}, model_->center, *B.tree,
               model_->reach, clearance);
}

void SweepWorker::set_share(double share) {
  share_ = share;
  sweep_ = sweep_by(share, question().clearance);
  turned_sizes_ = {sweep_.start.R.cwiseAbs(), sweep_.end.R.cwiseAbs()};
  // Of both readings of the path; see Bulge. What is kept from a longer motion is kept from the first part of it: its
  // readings are nearer to each other.
  passing_ = PassingPoints::seen_from_a(sweep_);
  floor_ = sweep_.floor + 0.125 * kUnitSlack * sweep_.theta2 * (model_->reach + sweep_.center_distance);
}

/// Goes down A's hierarchy to a block beside which there may be something of B.
void SweepWorker::next_block() {
  const Node node = stack_[--stacked_];
  if (stacked_ > 0 && stack_[stacked_ - 1].level == 0) surface_a_->lanes[stack_[stacked_ - 1].index].call_for();
  if (recedes(node)) return;
  walk_beside(node, 0);
  if (walk_.next(found_.data(), 1) == 0) return;
  if (node.level > 0) {
    push_below(node);
  } else if (!all_recede(node.index)) {
    place(node.index);
  }
}

/// Walks over what of B is beside A's node, and meets the box that is returned. What is under one goes on from what was
/// found for it.
AxisBox SweepWorker::walk_beside(const Node& node, std::uint32_t level) {
  const AxisBox box = swept(surface_a_->blocks.box(node.level, node.index));
  find_tops(node, box);
  walk(box, level);
  return box;
}

/// Those of A's node, if it may have nodes under it, in place of those of its level and below.
void SweepWorker::find_tops(const Node& node, const AxisBox& box) {
  for (std::uint32_t level = 1; level <= std::min(node.level, kTopLevels); ++level) tops_[level - 1].count = 0;
  if (node.level == 0 || node.level > kTopLevels || node.level >= surface_b().blocks.levels()) return;
  walk(box, node.level);
  Tops& tops = tops_[node.level - 1];
  tops.count = walk_.next(tops.nodes.data(), BlockWalk::kMostTops);
  if (tops.count == BlockWalk::kMostTops) tops.count = 0;
}

/// From the lowest nodes on that are known to be beside what the box is about.
void SweepWorker::walk(const AxisBox& box, std::uint32_t level) {
  for (std::uint32_t top = std::max(level, 1U); top <= kTopLevels; ++top) {
    const Tops& tops = tops_[top - 1];
    if (tops.count == 0) continue;
    walk_.start_under(tops.nodes.data(), tops.count, top, surface_b().blocks, box, level);
    return;
  }
  walk_.start(surface_b().blocks, box, level);
}

void SweepWorker::push_below(const Node& node) {
  const std::uint32_t below = surface_a_->blocks.nodes(node.level - 1), first = node.index * FaceBlocks::kFan;
  prefetch(surface_a_->blocks.boxes_below(node.level - 1, node.index));
  if (node.level <= surface_a_->slabs.levels()) surface_a_->slabs.call_for(node.level - 1, node.index);
  for (std::uint32_t i = first; i < std::min(first + FaceBlocks::kFan, below); ++i)
    stack_[stacked_++] = {node.level - 1, i};
}

/// What all points of a box of A pass, in B's axes.
AxisBox SweepWorker::swept(const AxisBox& box) const {
  Vec3 middle, half;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    middle[axis] = 0.5 * (double{box.low[i]} + double{box.high[i]});
    half[axis] = 0.5 * (double{box.high[i]} - double{box.low[i]});
  }
  Vec3 low = Vec3::Constant(kInfinity), high = -low;
  const double size = half.sum();
  for (std::size_t k = 0; k < 2; ++k) {
    const Placement& at = k == 0 ? sweep_.start : sweep_.end;
    const Vec3 to = at.R * (middle + offset_a_) + at.t;
    const Vec3 reach = turned_sizes_[k] * half + Vec3::Constant(floor_ + kBoxError * (to.lpNorm<1>() + size));
    low = low.cwiseMin(to - reach);
    high = high.cwiseMax(to + reach);
  }
  // What single precision leaves of them is far below the error that they are grown by.
  AxisBox out;
  for (std::size_t i = 0; i < 3; ++i) {
    out.low[i] = static_cast<float>(low[static_cast<Eigen::Index>(i)]);
    out.high[i] = static_cast<float>(high[static_cast<Eigen::Index>(i)]);
  }
  return out;
}

/// Whether all faces under A's node recede from the part, by what is known of them together.
bool SweepWorker::recedes(const Node& node) const {
  if (!may_recede() || node.level >= cones().nodes.size()) return false;
  const Slab& slab = surface_a_->slabs.slab(node.level, node.index);
  return passing_.recedes(seen(cones().nodes[node.level][node.index]), slab.center + offset_a_,
                          kRadiusSlack * slab.half.norm());
}

/// Whether no face of A's block recedes, by what is known of them together.
bool SweepWorker::none_recedes(std::uint32_t block) const {
  const Slab& slab = surface_a_->slabs.slab(0, block);
  return passing_.meets(seen(cones().nodes[0][block]), slab.center + offset_a_);
}

/// Whether all faces of A's block recede from the part, and so need not be looked at.
bool SweepWorker::all_recede(std::uint32_t block) {
  skipped_ = 0;
  if (!may_recede() || none_recedes(block)) return false;
  const std::uint32_t faces = surface_a_->blocks.faces(block);
  for (std::uint32_t k = 0; k < faces; ++k) {
    const std::uint32_t face = surface_a_->blocks.face(block, k);
    const Vec3 &p = model_->a->corner(face, 0), &q = model_->a->corner(face, 1), &r = model_->a->corner(face, 2);
    const Vec3 middle = (p + q + r) / 3;
    const double radius =
        std::sqrt(std::max({(p - middle).squaredNorm(), (q - middle).squaredNorm(), (r - middle).squaredNorm()}));
    if (passing_.recedes(seen((*cones().faces)[face]), middle - model_->center, kRadiusSlack * radius))
      skipped_ |= 1U << k;
  }
  return skipped_ == (1U << faces) - 1;
}

/// A's block where it is, and where it goes.
void SweepWorker::place(std::uint32_t block) {
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
  AxisBox box = moved_.box_without(skipped_);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto at = static_cast<float>(middle_[static_cast<Eigen::Index>(i)]);
    const float slack = static_cast<float>(floor_) + kBoxError * (std::abs(at) + 4 * moved_.size);
    box.low[i] += at - slack;
    box.high[i] += at + slack;
  }
  walk(box, 0);
  face_ = faces_;
  passed_ = asked_ = 0;
  sizes_passed_ = way / faces.size;
}

/// The next blocks of B beside that of A, for all faces of it.
bool SweepWorker::next_beside() {
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
void SweepWorker::look_less_far() {
  const double half = 0.5 * share_;
  task_->faces_end.lower({half, true});
  task_->end.lower({half, true});
  set_share(half);
  place(block_);
}

void SweepWorker::look_at_face(std::uint32_t k) {
  if ((skipped_ >> k & 1) != 0) return;
  for (std::uint32_t blocks = beside_.open(k), bit = 0; blocks != 0;) {
    const std::uint32_t faces = beside_.next_not_kept_apart(moved_, k, across_, blocks, bit);
    if (faces != 0 && !look_at_pairs(k, beside_.index(bit), faces)) return;
  }
}

/// Face `k` of A's block and those of a block of B that may be near. Whether the motion goes on as far as before.
bool SweepWorker::look_at_pairs(std::uint32_t k, std::uint32_t block, std::uint32_t open) {
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
    if (question().layer != Layer::faces) {
      task_->end_with(SweepTask::Ending::not_solid);
      return false;
    }
    meet(faces, face, face_b);
    // Over a shorter way from here on.
    place(block_);
    return false;
  }
  return true;
}

SweepWorker::Faces SweepWorker::faces_of(std::uint32_t face, std::uint32_t face_b) const {
  Faces out;
  for (int c = 0; c < 3; ++c) {
    out.a[c] = tree_a_->corner(face, c) + shift_a_ - model_->center;
    out.b[c] = part().tree->corner(face_b, c) - part().tree->origin();
    out.reach = std::max(out.reach, out.a[c].norm());
  }
  return out;
}

bool SweepWorker::keeps_apart(const Faces& faces) {
  MovingPlane plane = last_plane_.n0.isZero(0) ? MovingPlane{Vec3::UnitX(), Vec3::UnitX()} : last_plane_;
  if (!separate_triangles(faces.a, faces.b, sweep_, faces.reach, nullptr, plane)) return false;
  last_plane_ = plane;
  return true;
}

/// Something is in the way: the motion ends before it.
void SweepWorker::meet(const Faces& faces, std::uint32_t face, std::uint32_t face_b) {
  const bool far = question().kept_far > question().kept && free_until(faces, question().far) > 0;
  double until = free_until(faces, far ? question().kept_far : question().kept);
  // It was nearer at the start.
  if (until == 0) until = free_until(faces, question().clearance);
  task_->add_met({until, face, face_b});
  task_->faces_end.lower({until, false});
  task_->end.lower({until, false});
  set_share(until);
}

double SweepWorker::free_until(const Faces& faces, double clearance) const {
  const double length = question().d.dp.norm() + model_->reach * question().d.dr.norm();
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
