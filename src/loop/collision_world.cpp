#include "loop/collision_world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/deadline.hpp"
#include "loop/initial_separation.hpp"
#include "loop/mesh_structures.hpp"
#include "loop/scene_parts.hpp"
#include "narrowphase/fcl_motion_check.hpp"
#include "narrowphase/patch_motion_check.hpp"
#include "tegotae/core/clock.hpp"

namespace tegotae {
namespace {

// Pairs are followed while they are nearer than twice this share of the part's radius.
constexpr double kReachShare = 0.02;
// The held part is moved at most so many touch tolerances, and gap floors, off what it touches at the start: a corner
// with three faces takes 1.8.
constexpr double kMaxShift = 3;
// Share of the tick's budget for the test whether a pair that touched at the start has separated.
constexpr double kPollShare = 0.25;

// Parts of fewer triangles need no helpers.
constexpr std::size_t kHelpedFaces = 1024;

int helpers_of(const Part& held, const ContactSettings& settings) {
  if (deadline_after(0, settings.tick_budget) == kNoDeadline || held.mesh->triangles.size() < kHelpedFaces) return 0;
  return *settings.helper_threads;
}

/// Meshes and poses of the fixed parts, and of what stands in for some of them.
struct FixedParts {
  std::vector<std::shared_ptr<const TriangleMesh>> meshes;
  std::vector<Pose> poses;
  std::vector<FixedSurface> surfaces;
  std::map<const TriangleMesh*, std::shared_ptr<const Surface>>& known;

  void add(const std::shared_ptr<const TriangleMesh>& mesh, const Pose& pose, PartId id) {
    auto& surface = known[mesh.get()];
    if (!surface) surface = cached_surface(mesh);
    surfaces.push_back({surface, pose, id});
    poses.push_back(pose);
    meshes.push_back(mesh);
  }
};

std::unique_ptr<MotionCheck> make_check(const Part& held, const FixedParts& fixed, const ContactSettings& settings,
                                        const Vec3& center, double radius, const std::vector<std::uint32_t>& left_out,
                                        ProofEffort effort) {
  if (settings.narrowphase != NarrowPhase::fcl)
    return std::make_unique<PatchMotionCheck>(held.mesh, center, radius, fixed.meshes, fixed.poses, left_out, effort,
                                              helpers_of(held, settings));
  std::vector<const TriangleMesh*> meshes;
  for (const auto& mesh : fixed.meshes) meshes.push_back(mesh.get());
  return std::make_unique<FclMotionCheck>(*held.mesh, center, radius, meshes, fixed.poses, *settings.l_0);
}

}  // namespace

CollisionWorld::CollisionWorld(const Scene& scene, const ContactSettings& settings, const MassProperties& mass,
                               ProofEffort effort)
    : poll_time_(kPollShare * settings.tick_budget) {
  const SceneParts parts(scene);
  box_ = bounding_box(*parts.held->mesh);
  // Held here so that whoever needs a hierarchy while the scene is built finds it made.
  MeshStructures made(scene.parts, settings.narrowphase);
  start = InitialContacts(scene, settings);
  FixedParts fixed{{}, {}, {}, made.surfaces};
  for (std::size_t i = 0; i < parts.fixed.size(); ++i) {
    const Part& p = *parts.fixed[i];
    fixed.add(p.mesh, p.pose, parts.fixed_id[i]);
    spheres.add(bounding_sphere(*p.mesh), p.pose);
    boxes.add(bounding_box(*p.mesh), p.pose);
  }
  const auto copies = start.shrink(scene, mass.center, static_cast<std::uint32_t>(parts.fixed.size()));
  for (const InitialContacts::Copy& c : copies) fixed.add(c.mesh, parts.fixed[c.part]->pose, parts.fixed_id[c.part]);
  // Touching parts or copies of them, and suspended ones.
  std::vector<std::uint32_t> left_out;
  for (std::size_t i = 0; i < start.waiting(); ++i) left_out.push_back(start.waiting(i).part);
  for (auto copy = parts.fixed.size(); copy < fixed.meshes.size(); ++copy)
    left_out.push_back(static_cast<std::uint32_t>(copy));
  radius = radius_about(*parts.held->mesh, mass.center);
  reach = *settings.l_min + 2 * kReachShare * radius;
  check = make_check(*parts.held, fixed, settings, mass.center, radius, left_out, effort);
  contacts = std::make_unique<ContactSet>(made.surfaces.at(parts.held->mesh.get()), std::move(fixed.surfaces),
                                          mass.center, kMaxConstraints);
  X = initial_separation(*this, mass, parts.held->pose, kMaxShift * (settings.touch_tolerance + 2 * kGapFloor));
  double shift = 0;
  for (const Vec3& v : parts.held->mesh->vertices) shift = std::max(shift, (X * v - parts.held->pose * v).norm());
  start.set_shift(shift);
}

void CollisionWorld::query(const Pose& pose, const Vec3& center, double distance,
                           std::vector<std::uint32_t>& near) const {
  spheres.query(pose * center, radius, distance, near);
  boxes.keep_near(box_, pose, distance, near);
  start.apply(near);
}

bool CollisionWorld::is_path_free(const Pose& from, const Pose& to, const Vec3& center, const std::vector<bool>* fresh,
                                  std::int64_t deadline_ns, std::vector<std::uint32_t>& near,
                                  std::vector<FacePair>& blocking) const noexcept {
  const Displacement d = displacement(from, to, center);
  const double distance = d.dp.norm() + radius * d.dr.norm() + kGapFloor;
  spheres.query(from * center, radius, distance, near);
  boxes.keep_near(box_, from, distance, near);
  if (fresh != nullptr)
    near.erase(std::remove_if(near.begin(), near.end(), [fresh](std::uint32_t part) { return !(*fresh)[part]; }),
               near.end());
  start.apply(near);
  if (near.empty()) return true;
  check->begin(near, deadline_ns, OtherParts::ignored);
  blocking.clear();
  return check->check(from, d, kGapFloor, blocking) == MotionAnswer::free;
}

bool CollisionWorld::poll_initial_contacts(const Pose& pose) noexcept {
  const std::int64_t deadline = deadline_after(monotonic_ns(), poll_time_);
  const InitialContacts::Waiting* freed = start.poll(pose, *check, deadline);
  if (freed == nullptr) return false;
  if (freed->stand_in != InitialContacts::kNobody) contacts->transfer(freed->stand_in, freed->part);
  return true;
}

void CollisionWorld::fill_report(double contact_gap, TickReport& report) const noexcept {
  report.contacts = 0;
  report.contact_gap = contact_gap;
  report.gap = std::numeric_limits<double>::infinity();
  for (const Contact& c : contacts->constraints()) {
    if (c.age == kOneShotAge) continue;  // planes for one motion, not surfaces
    report.contacts += c.gap <= contact_gap ? 1 : 0;
    report.gap = std::min(report.gap, c.gap);
  }
  report.constraints = static_cast<int>(contacts->constraints().size());
  report.filtered = start.filtered();
  report.shrunk = start.shrunk();
  report.flags.overflow = contacts->overflow() > 0 || check->overflow();
}

}  // namespace tegotae
