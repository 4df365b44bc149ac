#include "sim/contact_loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "sim/start_check.hpp"
#include "tegotae/core/constants.hpp"

namespace tegotae {
namespace {

// Feature pairs, and limits from them, that a tick can hold; more are counted as overflow.
constexpr int kMostLimits = 4096;
// Intersecting triangle pairs asked for at a trial pose: what they miss shows at the next trial.
constexpr int kMostHits = 256;
// Near other parts a piece carries no point farther than this share of the part's radius, so that the poses checked lie
// close together.
constexpr double kPieceShare = 0.02;
// Pieces in one tick; a pen faster than that leaves X behind for a while.
constexpr int kMostPieces = 16;
// How much faster than the pen X may follow.
constexpr double kCatchUp = 2.0;
// A piece of at least this share of its longest was cut short by that, not by contacts.
constexpr double kFullShare = 0.99;
// Programmes solved for one piece before it is shortened instead.
constexpr int kMostResolves = 6;
// Halvings of a piece that still intersects.
constexpr int kMostHalvings = 4;
// Doublings of the back-off length.
constexpr int kMostBackOffs = 4;
// Share of l_min by which a gap that is too small recovers in a piece.
constexpr double kRecovery = 0.2;
// Contacts are kept at this share of l_min, so that rounding and curvature do not make a resting contact come and go.
constexpr double kKeepShare = 0.5;
// A motion that carries no point farther than this (m) is rest.
constexpr double kRest = 1e-10;
// Trust region: a piece that brought less than the first share of the promised decrease of the squared error halves it,
// more than the second doubles it; it never falls below this many times the pen's motion of the tick.
constexpr double kPoor = 0.25, kGood = 0.7, kPenShare = 1.5;

}  // namespace

ContactLoop::ContactLoop(const Scene& scene, const ContactSettings& settings, const MassProperties& mass)
    : settings_(settings),
      center_(mass.center),
      metric_(mass),
      resolver_(make_resolver(settings.resolver, kMostLimits)),
      rows_(kMostLimits),
      bounds_(kMostLimits) {
  const Part* held = nullptr;
  std::vector<const Part*> fixed;
  for (const Part& p : scene.parts) (p.held ? held = &p : (fixed.push_back(&p), held));
  std::map<const TriangleMesh*, std::shared_ptr<const Surface>> surfaces;
  std::vector<FixedSurface> fixed_surfaces;
  std::vector<const TriangleMesh*> meshes;
  for (const Part* p : fixed) {
    auto& surface = surfaces[p->mesh.get()];
    if (!surface) surface = std::make_shared<Surface>(p->mesh);
    fixed_surfaces.push_back({surface, p->pose});
    fixed_poses_.push_back(p->pose);
    spheres_.add(bounding_sphere(*p->mesh), p->pose);
    meshes.push_back(p->mesh.get());
  }
  narrow_ = std::make_unique<FclNarrowPhase>(*held->mesh, meshes);
  check_start(*held, fixed, *narrow_);
  held_ = std::make_shared<Surface>(held->mesh);
  contacts_ = std::make_unique<ContactSet>(held_, std::move(fixed_surfaces), center_, kMostLimits);
  radius_ = radius_about(*held->mesh, center_);
  piece_cap_ = kPieceShare * radius_;
  reach_ = settings_.l_min + 2 * piece_cap_;
  trust_ = piece_cap_;
  X_ = last_Y_ = held->pose;
  hits_.reserve(kMostHits);
}

void ContactLoop::step(const Pose& Y, double dt, TickReport& report) {
  const Pose X_before = X_;
  report.pieces.clear();
  report.resolves = report.iterations = 0;
  report.status = ResolveStatus::not_needed;
  report.overflow = false;
  const double wanted = size(displacement(X_, Y, center_));
  const double pen = size(displacement(last_Y_, Y, center_));
  last_Y_ = Y;
  spheres_.query(X_ * center_, radius_, wanted + reach_, near_);
  report.candidate_parts = static_cast<int>(near_.size());
  if (near_.empty()) {
    X_ = Y;
    report.pieces.push_back(X_);
    contacts_->track(X_, 0);
  } else {
    trust_ = std::max(trust_, std::min(piece_cap_, kPenShare * pen));
    // The pen's motion is followed within the tick, an older lag at twice its pace over the next ticks. A piece shorter
    // than it could be is the resolver's own end.
    const double travel = std::max(piece_cap_, kCatchUp * pen);
    double made = 0;
    for (int i = 0; i < kMostPieces && made < travel; ++i) {
      const double cap = std::min({trust_, piece_cap_, travel - made});
      const double length = move_piece(Y, cap, report);
      if (length > 0) report.pieces.push_back(X_);
      if (length < kFullShare * cap) break;
      made += length;
    }
    if (report.pieces.empty()) report.pieces.push_back(X_);
    contacts_->track(X_, reach_);
  }
  gather(report);
  const double left = size(displacement(X_, Y, center_));
  report.fraction = wanted > kRest ? std::clamp(1 - left / wanted, 0.0, 1.0) : 1;
  report.proxy.X = X_;
  const Displacement moved = displacement(X_before, X_, center_);
  report.proxy.velocity = dt > 0 ? Twist{moved.dp / dt, moved.dr / dt} : Twist{};
}

double ContactLoop::move_piece(const Pose& Y, double cap, TickReport& report) {
  metric_.set_orientation(X_.q);
  contacts_->track(X_, reach_);
  const Displacement error = displacement(X_, Y, center_);
  const Vec6 wanted = metric_.whiten(error);
  Trial trial;
  bool is_free = false;
  for (int i = 0; i < kMostResolves; ++i) {
    if (!resolve(wanted, cap, report, trial)) return 0;
    if (size(trial.d) < kRest) return 0;
    is_free = !find_hits(trial.X);
    if (is_free) break;
    if (contacts_->seed(hits_, back_off(trial.d)) == 0 && contacts_->cut(hits_, trial.d) == 0) break;
  }
  if (!is_free) {
    trust_ *= 0.5;
    if (!shorten(trial)) return 0;
  }
  if (!worth_it(wanted, trial, Y)) return 0;
  X_ = trial.X;
  return size(trial.d);
}

bool ContactLoop::resolve(const Vec6& wanted, double cap, TickReport& report, Trial& trial) {
  Vec6 motion = wanted;
  if (!contacts_->limits().empty() && !solve(wanted, report, motion)) return false;
  trial.d = metric_.unwhiten(motion);
  const double length = size(trial.d);
  if (length > cap) {
    // The direction is that of the whole way; its gaps are set right again at the length that is made, or a long way
    // would leave nearly nothing of their recovery.
    const Vec6 scaled = (cap / length) * motion;
    motion = scaled;
    if (!contacts_->limits().empty() && !solve(scaled, report, motion)) motion = scaled;
    trial.d = metric_.unwhiten(motion);
  }
  trial.X = displaced(X_, center_, trial.d);
  return true;
}

bool ContactLoop::solve(const Vec6& wanted, TickReport& report, Vec6& motion) {
  const auto& limits = contacts_->limits();
  const double keep = kKeepShare * settings_.l_min;
  rows_.clear();
  for (const Contact& c : limits) rows_.push_row(metric_.row(c));
  // Gaps that were lost to rounding or curvature recover where the programme allows it; without recovery it always has
  // an answer, because standing still is one.
  for (const double recovery : {kRecovery * settings_.l_min, 0.0}) {
    for (std::size_t i = 0; i < limits.size(); ++i)
      bounds_[i] = std::min(keep, limits[i].gap + recovery) - limits[i].gap;
    const Resolution r = resolver_->resolve(rows_, bounds_.data(), wanted);
    ++report.resolves;
    report.iterations += r.iterations;
    report.status = r.status;
    motion = r.motion;
    if (r.status == ResolveStatus::solved) return true;
  }
  return false;
}

bool ContactLoop::find_hits(const Pose& X) {
  hits_.clear();
  for (const std::uint32_t part : near_)
    narrow_->intersections(part, fixed_poses_[part].inverse() * X, kMostHits - static_cast<int>(hits_.size()), hits_);
  return !hits_.empty();
}

Pose ContactLoop::back_off(const Displacement& d) {
  // The paper moves A back by l_0 against the velocity of the vertices of its intersecting faces; here along its own
  // path, as far as takes the fastest of those vertices back by l_0, and again by twice as much while it still
  // intersects, never further than to the last free pose.
  const Vec3 c = X_ * center_;
  double fastest = 0;
  for (const TrianglePair& t : hits_)
    for (const std::uint32_t v : held_->mesh->triangles[t.a])
      fastest = std::max(fastest, (d.dp + d.dr.cross(X_ * held_->mesh->vertices[v] - c)).norm());
  double back = settings_.l_0;
  for (int i = 0; i < kMostBackOffs && back < fastest; ++i, back *= 2) {
    const Pose X = displaced(X_, center_, (1 - back / fastest) * d);
    const bool hit = std::any_of(near_.begin(), near_.end(), [&](std::uint32_t part) {
      return narrow_->intersects(part, fixed_poses_[part].inverse() * X);
    });
    if (!hit) return X;
  }
  return X_;
}

bool ContactLoop::shorten(Trial& trial) {
  for (int i = 0; i < kMostHalvings; ++i) {
    trial.d = 0.5 * trial.d;
    trial.X = displaced(X_, center_, trial.d);
    if (!find_hits(trial.X)) return true;
  }
  return false;
}

bool ContactLoop::worth_it(const Vec6& error, const Trial& trial, const Pose& Y) {
  // The programme sees flat limits. Where they curve, the error that it promises to take away does not all go, or even
  // grows: near the end of the way such steps would swing to and fro for ever.
  const Vec6 step = metric_.whiten(trial.d);
  const double promised = error.squaredNorm() - (error - step).squaredNorm();
  if (promised <= 0) return true;  // a step that only opens gaps
  const double made = error.squaredNorm() - metric_.whiten(displacement(trial.X, Y, center_)).squaredNorm();
  if (made < kPoor * promised) trust_ = 0.5 * std::min(trust_, size(trial.d));
  if (made > kGood * promised) trust_ = std::min(2 * trust_, piece_cap_);
  return made > 0;
}

void ContactLoop::gather(TickReport& report) const {
  report.contacts = 0;
  report.gap = std::numeric_limits<double>::infinity();
  for (const Contact& c : contacts_->limits()) {
    report.contacts += c.gap <= settings_.l_min ? 1 : 0;
    report.gap = std::min(report.gap, c.gap);
  }
  report.limits = static_cast<int>(contacts_->limits().size());
  report.overflow = contacts_->overflow() > 0;
  report.proxy.touching = report.contacts > 0;
}

}  // namespace tegotae
