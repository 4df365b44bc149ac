#include "experiments/friction_peg.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "experiments/friction_scenes.hpp"
#include "experiments/load_rig.hpp"

namespace tegotae::experiments {
namespace {

constexpr double kHalfPeg = 0.5 * kPegLength;

/// A contact of the planar peg: the hole's rim on the peg's side, or the peg's tip on the hole's wall; +1: the wall is
/// at +x.
struct PlanarContact {
  bool rim;
  double side;
};

/// x and tilt of the center of mass at rest, and the forces of the contacts, each with its friction up the insertion.
struct Planar {
  double x = 0, tilt = 0;
  std::vector<double> normal;
};

/// The peg's radius, and how high the rim is over its center.
struct PlanarPeg {
  double radius, rim;
};

/// How far the surface of that contact still is from the wall, m.
double gap(const PlanarPeg& peg, const Planar& p, const PlanarContact& c) {
  if (c.rim) return kPegRadius - peg.radius / std::cos(p.tilt) - c.side * (p.x + peg.rim * std::tan(p.tilt));
  return kPegRadius - peg.radius * std::cos(p.tilt) - c.side * (p.x - kHalfPeg * std::sin(p.tilt));
}

/// What a unit of the contact's force does in the world: along x, along z, and about the center.
Vec3 action(const PlanarPeg& peg, const Planar& p, const PlanarContact& c, double mu) {
  const double cosine = std::cos(p.tilt), sine = std::sin(p.tilt);
  // Forces in the peg's frame: the rim's is across the peg's side, the tip's across the hole's wall.
  const double fx = c.rim ? -c.side : -c.side * cosine - mu * sine;
  const double fz = c.rim ? mu : mu * cosine - c.side * sine;
  const double arm = c.rim ? (c.side * kPegRadius - p.x) * sine + peg.rim * cosine : -kHalfPeg;
  return {fx * cosine + fz * sine, fz * cosine - fx * sine, arm * fx - c.side * peg.radius * fz};
}

/// The springs, the contacts of `set` and their friction in balance; Newton's steps from the upright peg.
Planar balance(const PegLead& lead, const PlanarPeg& peg, const std::vector<PlanarContact>& set) {
  const CouplingSettings k;
  const auto n = static_cast<Eigen::Index>(set.size());
  Planar p;
  p.normal.assign(set.size(), 0);
  for (int step = 0; step < 12; ++step) {
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(2 + n, 2 + n);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(2 + n);
    a(0, 0) = -k.stiffness;
    b[0] = -k.stiffness * lead.offset;
    a(1, 1) = -k.torsional_stiffness;
    b[1] = -k.torsional_stiffness * lead.tilt;
    for (Eigen::Index i = 0; i < n; ++i) {
      const PlanarContact& c = set[static_cast<std::size_t>(i)];
      const Vec3 f = action(peg, p, c, lead.mu);
      a(0, 2 + i) = f[0];
      a(1, 2 + i) = f[2];
      constexpr double kStep = 1e-6;
      Planar turned = p;
      turned.tilt += kStep;
      const double now = gap(peg, p, c), slope = (gap(peg, turned, c) - now) / kStep;
      a(2 + i, 0) = -c.side;
      a(2 + i, 1) = slope;
      b[2 + i] = -now - c.side * p.x + slope * p.tilt;
    }
    const Eigen::VectorXd s = a.fullPivLu().solve(b);
    p.x = s[0];
    p.tilt = s[1];
    for (Eigen::Index i = 0; i < n; ++i) p.normal[static_cast<std::size_t>(i)] = s[2 + i];
  }
  return p;
}

/// Whether the mesh peg slides in the contact loop under a constant load. First `aside`, the load without the push,
/// brings it into contact on both sides: under the full load it would sink by up to a quarter of the depth while it
/// tilts through its play, and the result would belong to another point of the diagram.
bool slides(LoadRig& rig, const Wrench& aside, const Wrench& load) {
  constexpr int kComing = 40, kWatched = 20;
  constexpr double kFar = 1e-3, kGoesOn = 1e-5;  // m
  for (int i = 0; i < kComing; ++i) rig.step(rig.pen_for(aside));
  const double from = rig.X().p.z();
  const auto sunk_since = [&](int ticks) {
    const double begin = rig.X().p.z();
    for (int i = 0; i < ticks && from - rig.X().p.z() < kFar; ++i) rig.step(rig.pen_for(load));
    return begin - rig.X().p.z();
  };
  sunk_since(kComing);
  return from - rig.X().p.z() >= kFar || sunk_since(kWatched) > kGoesOn;
}

}  // namespace

bool whitney_slides(double lambda, double mu, double side, double moment) {
  return std::abs(side) < 1 / mu && std::abs(moment + mu * (1 + lambda) * side) < lambda;
}

std::vector<JamPoint> jam_map(double lambda, double mu, int grid) {
  constexpr double kPlay = 3.2e-6, kPush = 0.4;
  const double depth = 2 * kPegRadius * mu * lambda;
  std::vector<JamPoint> out;
  for (int i = 0; i < grid; ++i)
    for (int j = 0; j < grid; ++j) {
      JamPoint p;
      p.side = (-1.5 + 3 * (i + 0.5) / grid) / mu;
      p.moment = (-1.3 + 2.6 * (j + 0.5) / grid) * (1 + 2 * lambda);
      p.slides = whitney_slides(lambda, mu, p.side, p.moment);
      // About the center, which is half the peg's length over the tip.
      const auto load = [&](double push) {
        const Vec3 force(p.side * kPush, 0, -push);
        return Wrench{force, Vec3(0, -p.moment * kPegRadius * kPush, 0) + Vec3(0, 0, -kHalfPeg).cross(force)};
      };
      LoadRig rig(peg_in_hole(depth, kPlay, mu));
      p.slid = slides(rig, load(0), load(kPush));
      out.push_back(p);
    }
  return out;
}

double insertion_force(const PegLead& lead, double depth) {
  const PlanarPeg peg{kPegRadius - lead.play, depth - kHalfPeg};
  constexpr PlanarContact kAll[] = {{true, 1}, {true, -1}, {false, 1}, {false, -1}};
  // Of all sets of up to two contacts the one whose forces push and which no other surface cuts through.
  std::vector<std::vector<PlanarContact>> sets = {{}};
  for (const PlanarContact& c : kAll) sets.push_back({c});
  for (const PlanarContact& rim : {kAll[0], kAll[1]})
    for (const PlanarContact& tip : {kAll[2], kAll[3]}) sets.push_back({rim, tip});
  for (const auto& set : sets) {
    const Planar p = balance(lead, peg, set);
    bool good = true;
    double force = 0;
    for (std::size_t i = 0; i < set.size(); ++i) {
      good = good && p.normal[i] >= 0;
      force += p.normal[i] * action(peg, p, set[i], lead.mu)[1];
    }
    for (const PlanarContact& c : kAll) good = good && gap(peg, p, c) >= -1e-9;
    if (good) return force;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::vector<DepthForce> insert_peg(const PegLead& lead, int points) {
  constexpr double kFrom = 0.003, kTo = 0.035, kBring = 400, kSpeed = 2e-5;  // m, ticks, m a tick
  LoadRig rig(peg_in_hole(kFrom, lead.play, lead.mu));
  const Pose home = rig.X();
  const auto pen = [&](double along, double share) {
    return displaced(home, rig.loop().center(), {{share * lead.offset, 0, -along}, {0, share * lead.tilt, 0}});
  };
  for (int i = 0; i <= kBring; ++i) rig.step(pen(0, i / kBring));
  std::vector<DepthForce> out;
  for (double along = 0; along < 0.1 && static_cast<int>(out.size()) < points; along += kSpeed) {
    const Pose Y = pen(along, 1);
    const double kept = 0.5 * rig.step(Y).contact_gap;
    const double depth = kFrom + home.p.z() - rig.X().p.z();
    // Once it slides, at even depths.
    const double next = kFrom + 0.002 + (kTo - kFrom - 0.002) * static_cast<double>(out.size()) / (points - 1);
    if (depth < next) continue;
    // The gap that contacts keep is not play.
    PegLead left = lead;
    left.play -= kept;
    out.push_back({depth, rig.felt(Y).force.z(), insertion_force(left, depth)});
  }
  return out;
}

}  // namespace tegotae::experiments
