#include "shared/blocker.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "broadphase/bounding_spheres.hpp"
#include "loop/inward_offset.hpp"
#include "loop/running_scene.hpp"
#include "loop/scene_parts.hpp"
#include "mesh/surface.hpp"
#include "shared/clearance_probe.hpp"

namespace tegotae::apps {
namespace {

constexpr double kWindow = 0.5;     // s
constexpr double kStep = 0.01;      // s between two ticks that are looked at
constexpr double kRounding = 1e-6;  // s, of times

struct Touched {
  std::size_t ticks = 0;
  double push = 0;  // m, summed over the ticks
  Vec3 place_W = Vec3::Zero();
};

/// The ticks that are looked at: the last one, and back from it over the window.
std::vector<const TickPoses*> sampled(const std::vector<TickPoses>& ticks) {
  std::vector<const TickPoses*> out;
  for (auto tick = ticks.rbegin(); tick != ticks.rend() && tick->t >= ticks.back().t - kWindow; ++tick)
    if (out.empty() || tick->t <= out.back()->t - kStep + kRounding) out.push_back(&*tick);
  std::reverse(out.begin(), out.end());
  return out;
}

/// How far the held part would go into the other one at their nearest points, if it went from x to y; m.
double push(const TickPoses& tick, const Clearance& c) {
  if (!(c.distance > 0)) return 0;
  const Vec3 outwards = (c.on_held_W - c.on_other_W) / c.distance;
  const Vec3 wanted = tick.y * (tick.x.inverse() * c.on_held_W);
  return std::max(0.0, outwards.dot(c.on_held_W - wanted));
}

}  // namespace

Blocker find_blocker(const Scene& scene, const InitialContactReport& start, const std::vector<TickPoses>& ticks,
                     const std::atomic<bool>* stop) {
  const auto stopped = [stop] { return stop != nullptr && stop->load(std::memory_order_relaxed); };
  if (ticks.empty() || stopped()) return {};
  Scene felt = scene;
  std::set<std::size_t> unfelt;
  for (const InitialContact& pair : start.pairs) {
    std::shared_ptr<const TriangleMesh>& mesh = felt.parts[pair.part].mesh;
    if (pair.state == InitialContactState::shrunk)
      mesh = std::make_shared<TriangleMesh>(inward_offset(Surface(mesh), pair.inward_offset));
    if (pair.state == InitialContactState::filtered) unfelt.insert(pair.part);
  }
  const double reach = *completed(scene.contact, bounding_sphere(*held_part(scene).mesh).radius).l_min;
  ClearanceProbe probe(felt);
  std::vector<Clearance> near;
  std::map<std::size_t, Touched> touched;
  const Pose* last = nullptr;
  for (const TickPoses* tick : sampled(ticks)) {
    if (stopped()) return {};
    const bool stands = last && last->p == tick->x.p && last->q.coeffs() == tick->x.q.coeffs();
    if (!stands) probe.at(tick->x, reach, near);
    last = &tick->x;
    for (const Clearance& c : near) {
      if (c.distance > reach || unfelt.count(c.part) > 0) continue;
      Touched& one = touched[c.part];
      ++one.ticks;
      one.push += push(*tick, c);
      one.place_W = c.on_other_W;
    }
  }
  std::size_t most = 0;
  for (const auto& [part, one] : touched) most = std::max(most, one.ticks);
  const Touched* best = nullptr;
  Blocker out;
  for (const auto& [part, one] : touched) {
    if (2 * one.ticks < most) continue;
    if (best && (one.push != best->push ? one.push < best->push : one.ticks <= best->ticks)) continue;
    best = &one;
    out = {scene.parts[part].name, one.place_W};
  }
  return out;
}

}  // namespace tegotae::apps
