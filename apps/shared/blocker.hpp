#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "tegotae/core/pose.hpp"
#include "tegotae/loop/initial_contacts.hpp"
#include "tegotae/loop/scene.hpp"

namespace tegotae::apps {

/// The end of a tick.
struct TickPoses {
  double t = 0;  ///< s
  Pose y, x;     ///< X_WF of the held part: where the pen wanted it, and where it was
};

/// The part that was in the way at the end of a run.
struct Blocker {
  std::string part;             ///< its name; empty: none was
  Vec3 place_W = Vec3::Zero();  ///< of its surface, m
};

/// The part that the pen wanted to push the held one into, at the nearest points of the two, over the last half second
/// of `ticks`; only parts count that were touched (nearer than `l_min`) in half as many ticks at least as the most
/// touched one, and where it pushed into none it is that one. The place is where it was touched last. `ticks`: of a
/// run, in order; `start`: the initial contacts as they are at its end: a shrunk part is felt inside its surface, a
/// filtered one not at all. Depends on nothing else, so a recording gives what its run gave; but `stop` (may be null)
/// ends the search, and then there is none. Between two ticks that are looked at there are 10 ms, so that of large
/// surfaces that lie close, where a tick takes a tenth of a second, it takes seconds.
Blocker find_blocker(const Scene& scene, const InitialContactReport& start, const std::vector<TickPoses>& ticks,
                     const std::atomic<bool>* stop = nullptr);

}  // namespace tegotae::apps
