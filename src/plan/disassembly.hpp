#pragma once

#include <string>
#include <vector>

#include "plan/planner.hpp"

namespace tegotae {

/// How an assembly is taken apart. Parts are indices into Scene::parts, whoever is held there.
struct DisassemblyOptions {
  double clearance = 0;           ///< as PlanOptions::clearance
  std::uint64_t seed = 1;         ///< as PlanOptions::seed
  std::int64_t quick = 20;        ///< iterations of a first try with each part
  std::int64_t iterations = 500;  ///< of a second one, and with each group, where the first lets none out
  const std::atomic<bool>* stop = nullptr;
  /// Told before each try, and ten times a second in it: which parts, of how many that are left.
  std::function<void(const std::vector<std::size_t>& parts, std::size_t left)> progress = {};
};

/// One part, or a group that moves as one, that comes out of what was left.
struct Removal {
  std::vector<std::size_t> parts;
  std::vector<std::size_t> there;  ///< that were left then, these among them
  Plan plan;                       ///< in the scene of removal_scene()
};

/// Why a part did not come out when it was tried.
struct Blocked {
  std::size_t part = 0;
  std::vector<std::size_t> by;  ///< parts that were there and stopped it, those that stopped most motions first
  std::string error;            ///< why it could not be tried at all; empty: it was
};

struct Disassembly {
  std::vector<Removal> order;
  std::vector<std::size_t> left;                   ///< one part, unless the rest did not come apart
  std::vector<std::vector<std::size_t>> together;  ///< groups that came out and did not come apart
  std::vector<Blocked> blocked;  ///< the last try of each part that failed; the part may have come out later
  bool interrupted = false;
};

/// Takes an assembly apart: tries part after part, and where none comes out a part with one that stops it, together,
/// then such a pair with what stopped it most, up to five parts. A group that is out is taken apart by itself. The same
/// scene and options give the same order. Throws Error where there is no OMPL, and for fewer than two parts.
Disassembly take_apart(const Scene& scene, const DisassemblyOptions& options);

/// The scene of a removal: `parts` as the held part (a group as one mesh, in the world's frame) among the others of
/// `there`.
Scene removal_scene(const Scene& scene, const std::vector<std::size_t>& there, const std::vector<std::size_t>& parts);

}  // namespace tegotae
