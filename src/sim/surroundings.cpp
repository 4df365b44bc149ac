#include "sim/surroundings.hpp"

#include <algorithm>
#include <map>

#include "narrowphase/fcl_motion_check.hpp"
#include "narrowphase/patch_motion_check.hpp"
#include "sim/start_check.hpp"

namespace tegotae {
namespace {

// Pairs are followed while they are nearer than twice this share of the part's radius.
constexpr double kReachShare = 0.02;
// Of a start gap below the floor, what motions must leave.
constexpr double kStartShare = 0.5;

double start_clearance(const SceneParts& parts, FclNarrowPhase& narrow) {
  double clearance = kGapFloor;
  FacePair nearest{};
  for (std::uint32_t i = 0; i < parts.fixed.size(); ++i) {
    const Pose X_BA = parts.fixed[i]->pose.inverse() * parts.held->pose;
    clearance = std::min(clearance, narrow.distance_below(kGapFloor, i, X_BA, nearest));
  }
  return clearance < kGapFloor ? kStartShare * clearance : clearance;
}

}  // namespace

SceneParts::SceneParts(const Scene& scene) {
  for (const Part& p : scene.parts) (p.held ? held = &p : (fixed.push_back(&p), held));
}

Surroundings::Surroundings(const Scene& scene, const ContactSettings& settings, const MassProperties& mass) {
  const SceneParts parts(scene);
  std::map<const TriangleMesh*, std::shared_ptr<const Surface>> surfaces;
  std::vector<FixedSurface> fixed_surfaces;
  std::vector<const TriangleMesh*> plain_meshes;
  std::vector<std::shared_ptr<const TriangleMesh>> meshes;
  std::vector<Pose> poses;
  for (const Part* p : parts.fixed) {
    auto& surface = surfaces[p->mesh.get()];
    if (!surface) surface = std::make_shared<Surface>(p->mesh);
    fixed_surfaces.push_back({surface, p->pose});
    poses.push_back(p->pose);
    spheres.add(bounding_sphere(*p->mesh), p->pose);
    meshes.push_back(p->mesh);
    plain_meshes.push_back(p->mesh.get());
  }
  FclNarrowPhase narrow(*parts.held->mesh, plain_meshes);
  check_start(*parts.held, parts.fixed, narrow);
  radius = radius_about(*parts.held->mesh, mass.center);
  clearance = start_clearance(parts, narrow);
  reach = settings.l_min + 2 * kReachShare * radius;
  if (settings.narrowphase == "fcl")
    check =
        std::make_unique<FclMotionCheck>(*parts.held->mesh, mass.center, radius, plain_meshes, poses, settings.l_0);
  else
    check = std::make_unique<PatchMotionCheck>(parts.held->mesh, mass.center, radius, meshes, poses);
  contacts = std::make_unique<ContactSet>(std::make_shared<Surface>(parts.held->mesh), std::move(fixed_surfaces),
                                          mass.center, kMostLimits);
}

}  // namespace tegotae
