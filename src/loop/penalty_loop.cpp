#include "loop/penalty_loop.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "loop/collision_world.hpp"
#include "loop/scene_parts.hpp"
#include "narrowphase/patch_cache.hpp"
#include "narrowphase/patch_motion_check.hpp"
#include "tegotae/core/clock.hpp"

namespace tegotae {
namespace {

// Steps in a tick, and rounds in which springs are found to push or not in one step.
constexpr int kMaxSteps = 4, kMaxRounds = 12;
// A step carries no point farther than this share of the part's radius: springs are straightened at its start.
constexpr double kStepShare = 0.02;
// Steps shorter than this (m) are rest.
constexpr double kPenaltyRest = 1e-8;
constexpr std::size_t kMaxSprings = 16384;

}  // namespace

PenaltyLoop::PenaltyLoop(const Scene& scene, const ContactSettings& settings, const MassProperties& mass)
    : settings_(settings), coupling_(scene.coupling), center_(mass.center) {
  const SceneParts parts(scene);
  ids_ = parts.fixed_id;
  std::map<const TriangleMesh*, std::shared_ptr<const SignedDistance>> fields;
  const auto field = [&fields](const std::shared_ptr<const TriangleMesh>& mesh) {
    auto& f = fields[mesh.get()];
    if (!f) f = std::make_shared<SignedDistance>(cached_surface(mesh), cached_patch_tree(mesh));
    return f;
  };
  start_ = InitialContacts(scene, settings);
  std::vector<std::shared_ptr<const TriangleMesh>> meshes;
  for (const Part* p : parts.fixed) {
    spheres_.add(bounding_sphere(*p->mesh), p->pose);
    poses_.push_back(p->pose);
    meshes.push_back(p->mesh);
    shells_.emplace_back(field(parts.held->mesh), field(p->mesh));
  }
  radius_ = radius_about(*parts.held->mesh, center_);
  if (start_.waiting() > 0)
    check_ = std::make_unique<PatchMotionCheck>(parts.held->mesh, center_, radius_, meshes, poses_,
                                                std::vector<std::uint32_t>{});
  X_ = parts.held->pose;
  near_.reserve(parts.fixed.size());
  points_.reserve(kMaxSprings);
  springs_.reserve(kMaxSprings);
  constraints_.reserve(kMaxSprings);
}

void PenaltyLoop::move(const Displacement& d) {
  X_ = displaced(X_, center_, d);
  collected_ = false;
  for (VertexShell& shell : shells_) shell.move(size(d));
}

void PenaltyLoop::query(double distance) {
  spheres_.query(X_ * center_, radius_, distance, near_);
  start_.apply(near_);
}

void PenaltyLoop::collect(double reach, TickReport& report) {
  springs_.clear();
  constraints_.clear();
  collected_ = true;
  report.contacts = 0;
  report.contact_gap = 0;
  report.depth = 0;
  report.gap = std::numeric_limits<double>::infinity();
  query(reach);
  report.candidate_parts = static_cast<int>(near_.size());
  const Vec3 c = X_ * center_;
  for (const std::uint32_t part : near_) {
    points_.clear();
    report.flags.overflow |= !shells_[part].collect(poses_[part].inverse() * X_, reach, points_);
    for (const ShellPoint& p : points_) {
      if (springs_.size() == springs_.capacity()) {
        report.flags.overflow = true;
        return;
      }
      const Vec3 n = X_.q * p.n_A, r = X_ * p.p_A - c;
      Spring s;
      s.gap = p.gap;
      s.row << n, r.cross(n);
      springs_.push_back(s);
      constraints_.push_back({n, r, p.gap, ids_[part], 0, p.on_a, p.on_b});
      report.contacts += p.gap < 0 ? 1 : 0;
      report.depth = std::max(report.depth, -p.gap);
      report.gap = std::min(report.gap, p.gap);
    }
  }
}

Vec6 PenaltyLoop::balance(const Vec6& error, const Vec6& made, double dt) const {
  Vec6 pull;
  pull << Vec3::Constant(coupling_.stiffness), Vec3::Constant(coupling_.torsional_stiffness);
  const double k = settings_.penalty.stiffness, c = dt > 0 ? settings_.penalty.damping / dt : 0;
  Vec6 d = Vec6::Zero();
  for (int round = 0; round < kMaxRounds; ++round) {
    Eigen::Matrix<double, 6, 6> H = pull.asDiagonal();
    Vec6 g = pull.cwiseProduct(error);
    for (const Spring& s : springs_) {
      if (s.gap + s.row.dot(d) >= 0) continue;
      H.noalias() += (k + c) * s.row * s.row.transpose();
      g -= (k * s.gap + c * s.row.dot(made)) * s.row;
    }
    const Vec6 next = H.ldlt().solve(g);
    const double change = (next - d).head<3>().norm() + radius_ * (next - d).tail<3>().norm();
    d = next;
    if (change < kPenaltyRest) break;
  }
  return d;
}

bool PenaltyLoop::take_over(const TickReport& last, const Pose&, const std::vector<bool>*, std::int64_t) {
  move(displacement(X_, last.proxy.X, center_));
  X_ = last.proxy.X;
  return true;
}

void PenaltyLoop::step(const Pose& Y, double dt, std::int64_t deadline_ns, TickReport& report) {
  const Pose X_before = X_;
  const double wanted = size(displacement(X_, Y, center_)), most = kStepShare * radius_;
  if (check_) start_.poll(X_, *check_, deadline_ns);
  report.filtered = start_.filtered();
  query(wanted);
  if (near_.empty()) {
    move(displacement(X_, Y, center_));
    X_ = Y;
  }
  // One linear step a tick; more only for a pen that is farther than a step may go.
  for (int i = 0; i < kMaxSteps && !near_.empty(); ++i) {
    if (!collected_) collect(most, report);
    const Displacement e = displacement(X_, Y, center_), m = displacement(X_before, X_, center_);
    Vec6 error, made;
    error << e.dp, e.dr;
    made << m.dp, m.dr;
    const Vec6 step = springs_.empty() ? error : balance(error, made, dt);
    ++report.resolves;
    Displacement d{step.head<3>(), step.tail<3>()};
    const double length = size(d);
    if (length > most) d = most / length * d;
    report.constraints = std::max(report.constraints, static_cast<int>(springs_.size()));
    if (!springs_.empty()) report.status = ResolveStatus::solved;
    move(d);
    report.flags.timed_out = past(deadline_ns);
    if (length <= most || report.flags.timed_out) break;
  }
  collect(most, report);
  report.substeps.push_back(X_);
  const double left = size(displacement(X_, Y, center_));
  report.fraction = wanted > kPenaltyRest ? std::clamp(1 - left / wanted, 0.0, 1.0) : 1;
  report.lag_reason = left <= kPenaltyRest  ? LagReason::none
                      : report.contacts > 0 ? LagReason::contact
                                            : LagReason::time;  // a step or a tick has its longest motion
  report.proxy.touching = report.lag_reason == LagReason::contact || report.flags.timed_out;
  report.proxy.X = X_;
  const Displacement moved = displacement(X_before, X_, center_);
  report.proxy.velocity = dt > 0 ? Twist{moved.dp / dt, moved.dr / dt} : Twist{};
}

}  // namespace tegotae
