#include "plan/motion_world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "broadphase/bounding_spheres.hpp"
#include "loop/contact_loop.hpp"
#include "loop/scene_parts.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/mesh/report.hpp"

namespace tegotae {
namespace {

// Triangle pairs in the way that are looked at; the first of them names a part.
constexpr std::size_t kMaxBlocking = 64;
// A contact below this many clearances is a contact, and half of it is kept: a little more than the clearance, so that
// what the loop does passes the certificate.
constexpr double kContactShare = 2.4;
// Ticks of one compliant motion, and the least that the part goes in one, as a share of its radius: less is rest.
constexpr int kMaxTicks = 120;
constexpr double kRestShare = 1e-4;
// So many ticks of rest in a row are the end: in the first ones the loop finds contacts and may make no motion.
constexpr int kRestTicks = 4;
// A motion that is not proved is not told as a whole one, however little is missing.
constexpr double kMinProof = 1e-6;
constexpr double kTick = 1e-3;  // s; nothing depends on it

/// The scene with the settings of a planner: work alone bounds a tick, nothing rubs or weighs, and a turn weighs as
/// much as the way that it carries the part's points on average.
Scene prepare(Scene scene, double clearance) {
  checked(scene);
  if (!(clearance >= kGapFloor)) throw Error("the clearance of a plan is at least 1.1 um");
  ContactSettings& contact = scene.contact;
  contact.tick_budget = std::numeric_limits<double>::infinity();
  contact.resolver = ResolverKind::qp;
  contact.custom_resolver = {};
  contact.narrowphase = NarrowPhase::patch;
  if (clearance > kGapFloor) contact.l_min = kContactShare * clearance;
  scene.friction = {};
  scene.weight = {};
  scene.scale = 1;
  scene.max_torsional_stiffness.reset();
  const TriangleMesh& mesh = *held_part(scene).mesh;
  const double gyration = radius_of_gyration(mass_properties(mesh, report(mesh).closed));
  scene.coupling.torsional_stiffness = scene.coupling.stiffness * gyration * gyration;
  return scene;
}

}  // namespace

MotionWorld::MotionWorld(Scene scene, double clearance)
    : MotionWorld(prepare(std::move(scene), clearance), clearance, true) {}

MotionWorld::MotionWorld(Scene scene, double clearance, bool)
    : scene_(std::move(scene)),
      clearance_(clearance),
      settings_(completed(scene_.contact, bounding_sphere(*held_part(scene_).mesh).radius)),
      mass_(mass_of_held(scene_, settings_.density)),
      at_(std::make_unique<CollisionWorld>(scene_, settings_, mass_, ProofEffort::quick)),
      gyration_(radius_of_gyration(mass_)) {
  const SceneParts parts(scene_);
  for (const PartId id : parts.fixed_id) fixed_.push_back(id.index);
  near_.reserve(fixed_.size());
  blocking_.reserve(kMaxBlocking);
  report_.substeps.reserve(kMaxSubsteps);
  // What touches is moved off as the certificate can tell, and is to start where it does in a loop.
  if (at_->start.waiting() > 0) complete();
}

void MotionWorld::complete() {
  if (is_complete()) return;
  loop_ = std::make_unique<RunningScene>(scene_);
  at_ = std::make_unique<CollisionWorld>(scene_, settings_, mass_);
}

double MotionWorld::free_share(const Pose& from, const Pose& to, double clearance, int again) {
  ++counts_.checked;
  const Displacement d = displacement(from, to, center());
  const int parts = std::max(1, static_cast<int>(std::ceil(size(d) / at_->check->longest_motion())));
  double share = 0;
  for (int i = 0; i < parts;) {
    // From where the proof has come to the end of this part of the motion.
    const double end = i + 1 == parts ? 1 : static_cast<double>(i + 1) / parts;
    const Displacement step = (end - share) * d;
    const Pose X = share == 0 ? from : displaced(from, center(), share * d);
    const double made = step_share(X, step, clearance);
    share = made == 1 ? end : share + made * (end - share);
    i += made == 1 ? 1 : 0;
    if (made == 1) continue;
    // Where something is in the way, asking again from its place tells the same.
    if (--again < 0 || (blocked_ && made <= kMinProof)) return std::min(share, 1 - kMinProof);
  }
  return 1;
}

double MotionWorld::step_share(const Pose& X, const Displacement& step, double clearance) {
  at_->query(X, center(), size(step) + clearance, near_);
  if (near_.empty()) return 1;
  at_->check->begin(near_, kNoDeadline, OtherParts::ignored);
  blocking_.clear();
  const MotionAnswer answer = at_->check->check(X, step, clearance, blocking_);
  if (answer == MotionAnswer::free) return 1;
  blocked_ = answer == MotionAnswer::blocked;
  blocker_.reset();
  if (!blocking_.empty()) {
    // Copies of fixed parts are numbered after them.
    std::uint32_t part = blocking_.front().part;
    for (std::size_t w = 0; w < at_->start.waiting(); ++w)
      if (at_->start.waiting(w).stand_in == part) part = at_->start.waiting(w).part;
    if (part < fixed_.size()) blocker_ = fixed_[part];
  }
  const double share = std::min(at_->check->free_share(), 1 - kMinProof);
  // Cells that took over a part, which they keep until it was out of sight, give it back: what follows is elsewhere.
  near_.clear();
  at_->check->begin(near_, kNoDeadline, OtherParts::ignored);
  return share;
}

void MotionWorld::comply(const Pose& from, const Pose& target, double longest, std::vector<Pose>& pieces) {
  ++counts_.complied;
  pieces.clear();
  complete();
  // The loop of these settings (see prepare()).
  static_cast<ContactLoop&>(*loop_->loop).stand_at(from);
  Pose X = from;
  double gone = 0;
  int rest = 0;
  for (int tick = 0; tick < kMaxTicks && gone < longest; ++tick) {
    reset(report_);
    loop_->loop->step(target, kTick, kNoDeadline, report_);
    const double moved = size(X, report_.proxy.X);
    rest = moved < kRestShare * radius() ? rest + 1 : 0;
    if (rest == kRestTicks) break;
    pieces.insert(pieces.end(), report_.substeps.begin(), report_.substeps.end());
    X = report_.proxy.X;
    gone += moved;
  }
  if (clearance_ <= kGapFloor) return;
  // The loop itself asks for kGapFloor alone.
  Pose last = from;
  const auto stop = std::find_if(pieces.begin(), pieces.end(),
                                 [&](const Pose& next) { return !is_free(std::exchange(last, next), next); });
  pieces.erase(stop, pieces.end());
}

}  // namespace tegotae
