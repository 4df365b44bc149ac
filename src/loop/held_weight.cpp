#include "loop/held_weight.hpp"

#include <algorithm>

#include "core/number_text.hpp"
#include "loop/scene_parts.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

// Beyond, numbers are no longer those of a part or a place (kg, m/s²).
constexpr double kMaxMass = 1e6, kMaxGravity = 1e3;

// Of what the motors can sustain; the rest is for contacts.
constexpr double kWeightShare = 0.5;

}  // namespace

HeldWeight held_weight(const Scene& scene, const MassProperties& mass) {
  HeldWeight out;
  const WeightSettings& s = scene.weight;
  if (!s.on) return out;
  if (!scene.contact.custom_resolver && scene.contact.resolver != ResolverKind::qp)
    throw Error(ErrorKind::setting,
                "weight: the resolver " + to_string(scene.contact.resolver) + " does not support weight; qp does",
                {{}, 0, "weight", {}});
  if (!(s.gravity.norm() <= kMaxGravity))
    throw Error(ErrorKind::setting, "weight: gravity must be three numbers of up to 1000 m/s²",
                {{}, 0, "weight.gravity", {}});
  const Part& held = held_part(scene);
  out.mass = held.mass.value_or(mass.mass);
  if (!(out.mass > 0 && out.mass <= kMaxMass))
    throw Error(
        ErrorKind::setting,
        "part \"" + held.name + "\": the mass must be above 0 and at most 1e6 kg, not " + std::to_string(out.mass),
        {{}, 0, "part.mass", held.name});
  const double newtons = out.mass * s.gravity.norm();
  if (s.max_force && newtons > *s.max_force) out.share = std::max(0.0, *s.max_force) / newtons;
  out.force = out.share * out.mass * s.gravity;
  return out;
}

std::optional<double> weight_bound(double continuous_force) {
  if (!(continuous_force > 0)) return std::nullopt;
  return kWeightShare * continuous_force;
}

std::string weight_text(const Scene& scene, const HapticLoop& loop) {
  const HeldWeight& w = loop.weight();
  if (!scene.weight.on) return {};
  const auto text = [](double x) { return number_text(x, 3); };
  const std::string force = text(w.force.norm()) + " N", mass = text(w.mass) + " kg";
  if (w.share >= 1) return force + " (" + mass + ")";
  return force + " of the " + text(w.force.norm() / w.share) + " N that " + mass + " weigh (" + text(w.share) +
         " of it: half of what the device can sustain)";
}

}  // namespace tegotae
