#include "review/headline.hpp"

#include <algorithm>

#include "review/verdict.hpp"

namespace tegotae::review {
namespace {

/// What going to the goal means.
enum class Way {
  in,        ///< nearer to the others
  out,       ///< out of all others
  outwards,  ///< away from them, and still not out of them
  beside     ///< from outside to outside
};

Way way(bool out, const Findings& f, bool inwards) {
  if (!out) return inwards || f.exit.at_first ? Way::in : Way::outwards;
  return f.exit.at_first ? Way::beside : Way::out;
}

/// That it got to its goal, in the recording's end or (`left`) before.
std::string arrives(const Findings& f, const Scene& scene, bool inwards, const std::string& left) {
  switch (way(f.exit.at_end, f, inwards)) {
    case Way::in:
      return "It goes in" + left;
    case Way::out:
      return "It comes out" + left;
    case Way::beside:
      return "It gets to its goal" + left + "; it was out of the other parts where it began";
    case Way::outwards:
      break;
  }
  return "It gets to its goal, " + length_text(f.goal->there_depth) + " on the way out" + left + "; still " +
         (f.exit.inside.empty() ? "not beside the other parts" : "inside " + names_text(f.exit.inside, scene));
}

/// That it is not at its goal.
std::string stays(const Findings& f, bool inwards) {
  const std::string why = ": " + apps::blocked_text(f.blocker);
  const Way to = way(f.exit.at_goal, f, inwards);
  if (to == Way::in) return "It does not go in" + why;
  if (to == Way::out && !f.exit.at_end) return "It does not come out" + why;
  if (to == Way::out) return "It does not get to its goal, though it is out of the other parts" + why;
  return "It does not get to its goal" + why;
}

/// Where the goal is no farther from the start than its tolerance, being there says nothing.
Headline at_the_start(const Findings& f) {
  const std::string where = "where it began, within " + length_text(f.goal->tolerance);
  if (f.goal->reached) return {Outcome::open, "Its goal is " + where + ": there is nothing to say about its way"};
  return {Outcome::does_not_go, "It does not get back to its goal, " + where + ": " + apps::blocked_text(f.blocker)};
}

}  // namespace

Headline headline(const Findings& f, const Scene& scene, bool inwards) {
  const auto& pairs = f.start.pairs;
  const auto deeper = std::find_if(pairs.begin(), pairs.end(), [](const StartFinding& pair) {
    return pair.pair.state == InitialContactState::shrunk && pair.deeper > 0;
  });
  if (f.start.intersecting > 0)
    return {Outcome::does_not_go,
            std::to_string(f.start.intersecting) + " poses intersect other parts: impossible for a rigid part"};
  if (deeper != pairs.end())
    return {Outcome::does_not_go, std::to_string(deeper->deeper) + " poses reach deeper into " +
                                      scene.parts[deeper->pair.part].name +
                                      " than at the start: impossible for a rigid part"};
  if (!f.goal) return {Outcome::open, "A way of " + length_text(f.way) + " without a goal"};
  const GoalFindings& g = *f.goal;
  if (g.cut && !g.reached)
    return {Outcome::open,
            "It ends before its script does, " + length_text(g.depth) + " of " + length_text(g.way) + " on the way"};
  if (g.starts_there) return at_the_start(f);
  if (g.reached) return {Outcome::goes, arrives(f, scene, inwards, "")};
  if (g.passed && !g.by_end)
    return {Outcome::goes, arrives(f, scene, inwards, ", and leaves again: it was there after " + seconds_text(g.at))};
  return {Outcome::does_not_go, stays(f, inwards)};
}

}  // namespace tegotae::review
