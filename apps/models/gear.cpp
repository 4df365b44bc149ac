#include "models/gear.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/numbers.hpp"
#include "models/mesh_builder.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::shapes {
namespace {

double involute(double angle) {
  return std::tan(angle) - angle;
}

/// One tooth's outline as (radius, azimuth from its middle), in the direction of growing azimuth, root to root.
std::vector<std::pair<double, double>> tooth(const Gear& g) {
  const double pitch = g.module * g.teeth / 2, base = pitch * std::cos(g.pressure_angle);
  const double tip = pitch + g.module, root = pitch - 1.25 * g.module, start = std::max(base, root);
  const double half = kPi / (2 * g.teeth) - g.backlash / (2 * pitch) + involute(g.pressure_angle);
  std::vector<std::pair<double, double>> right;
  if (root < base) right.emplace_back(root, half);
  for (int i = 0; i <= g.flank; ++i) {
    const double r = start + (tip - start) * i / g.flank;
    right.emplace_back(r, half - involute(std::acos(std::min(1.0, base / r))));
  }
  if (!(right.back().second > 0)) throw Error("a gear's teeth are pointed");
  std::vector<std::pair<double, double>> out;
  for (const auto& [r, a] : right) out.emplace_back(r, -a);
  for (auto i = right.rbegin(); i != right.rend(); ++i) out.push_back(*i);
  return out;
}

}  // namespace

TriangleMesh gear(const Gear& g) {
  const double root = g.module * (g.teeth / 2.0 - 1.25);
  if (!(g.module > 0 && g.teeth >= 8 && g.width > 0 && g.flank >= 1 && g.layers >= 1 && g.backlash >= 0))
    throw Error("a gear needs a module, 8 teeth, a width, facets and layers");
  if (!(g.bore > 0 && g.bore / 2 < 0.95 * root)) throw Error("a gear's bore does not fit");
  MeshBuilder b("gear");
  const auto one = tooth(g);
  std::vector<Ring> outside, inside;
  for (int k = 0; k <= g.layers; ++k) {
    const double z = g.width * k / g.layers;
    Ring out, in;
    for (int i = 0; i < g.teeth; ++i) {
      for (const auto& [r, a] : one) {
        const double angle = 2 * kPi * i / g.teeth + a;
        out.push_back(b.vertex({r * std::cos(angle), r * std::sin(angle), z}));
        in.push_back(b.vertex({g.bore / 2 * std::cos(angle), g.bore / 2 * std::sin(angle), z}));
      }
    }
    outside.push_back(out);
    inside.push_back(in);
  }
  for (int k = 0; k < g.layers; ++k) {
    b.band(outside[k], outside[k + 1]);
    b.band(inside[k + 1], inside[k]);
  }
  b.band(inside.front(), outside.front());
  b.band(outside.back(), inside.back());
  return b.take();
}

}  // namespace tegotae::shapes
