#include "plan/ompl_connect.hpp"

#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/datastructures/NearestNeighborsGNAT.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <utility>

#include "plan/common_axes.hpp"
#include "plan/growing_paths.hpp"

namespace tegotae {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

// Of the held part's radius: the longest edge, the shortest one that is worth a node, and how near to a pose that is
// known a new one is the same.
constexpr double kRange = 0.5, kMinEdge = 0.01, kSame = 0.01;
// Edges that one iteration adds at most, each beginning where the last one ended. A motion of a pose's own that gets
// through is made once more, as long as it does: a screw goes on turning.
constexpr int kMaxEdges = 64;
// Of a motion, what has to have been made for that.
constexpr double kThrough = 0.5;
// A motion about a common axis: the longest turn of an edge (rad), and how far the center of mass, which goes straight
// in an edge, may then be beside its way around the axis (m).
constexpr double kAxisTurn = 2, kMaxSagitta = 2e-6;
// How far trees are joined by one motion, in edges.
constexpr double kJoinReach = 8;
// A pose to begin at is the newest one, or of so many the one that was begun at least often.
constexpr double kNewest = 0.3;
constexpr int kContest = 4;
// Own motions, in edges; and the longest turn (rad): beyond half a turn the way there is the other one.
constexpr double kShortestMotion = 0.1, kLongestMotion = 6, kMaxTurn = 3;
// Of the iterations, those of the goals' tree: where many poses are out, it has little to find.
constexpr double kGoalShare = 0.5, kExitShare = 0.15;

/// A pose that is within reach of its tree's root.
struct Node {
  Pose X;
  Node* parent = nullptr;
  std::vector<Pose> edge;  ///< poses between the parent and this one, and this one
  int begun = 0;           ///< how often a motion began here
};

/// What an iteration tries.
struct Aim {
  Node* node;
  Pose target;
  std::optional<Displacement> again;  ///< what to go on with when the target is reached
};

struct Tree {
  explicit Tree(bool known) : ways(known) {}

  std::deque<Node> nodes;
  std::unique_ptr<ompl::NearestNeighborsGNAT<Node*>> near;
  GrowingPaths ways;
};

class CompliantConnect final : public ob::Planner {
 public:
  CompliantConnect(const ob::SpaceInformationPtr& si, std::shared_ptr<PoseSpace> space, MotionWorld& world,
                   const SearchTask& task, SearchResult& result)
      : ob::Planner(si, "CompliantConnect"),
        space_(std::move(space)),
        world_(world),
        task_(task),
        result_(result),
        range_(kRange * world.radius()),
        from_start_(!task.known.empty()),
        from_goals_(!task.known.empty()) {
    sampler_ = si->allocStateSampler();
    for (Tree* tree : {&from_start_, &from_goals_}) {
      tree->near = std::make_unique<ompl::NearestNeighborsGNAT<Node*>>();
      tree->near->setDistanceFunction([this](Node* const& a, Node* const& b) { return distance(a->X, b->X); });
    }
  }

  ob::PlannerStatus solve(const ob::PlannerTerminationCondition& ended) override {
    checkValidity();
    add(from_start_, nullptr, task_.start, {});
    for (const Pose& goal : task_.goals) add(from_goals_, nullptr, goal, {});
    if (arrived(from_start_, from_start_.nodes.front())) return finish();
    if (follow_axes(ended) || follow_known(ended)) return finish();
    for (const Pose& goal : task_.goals) {
      if (ended || result_.iterations >= task_.iterations) break;
      if (iterate(from_start_, {&from_start_.nodes.front(), goal, {}}, ended)) return finish();
    }
    const double goal_share = task_.exit != nullptr ? kExitShare : kGoalShare;
    while (!ended && result_.iterations < task_.iterations) {
      Tree& tree = rng_.uniform01() < goal_share ? from_goals_ : from_start_;
      GrowingPath& way = tree.ways.choose(rng_.uniform01());
      const std::size_t before = tree.nodes.size();
      if (iterate(tree, aim(tree, way), ended)) return finish();
      GrowingPaths::report(way, tree.nodes.size() > before);
    }
    result_.path = path_to(farthest_);
    return ob::PlannerStatus::TIMEOUT;
  }

 private:
  double distance(const Pose& a, const Pose& b) const {
    const Displacement d = displacement(a, b, world_.center());
    return d.dp.norm() + world_.gyration() * d.dr.norm();
  }
  Tree& other(const Tree& tree) { return &tree == &from_start_ ? from_goals_ : from_start_; }

  Node& nearest(Tree& tree, const Pose& X) {
    probe_.X = X;
    return *tree.near->nearest(&probe_);
  }
  Node& random_node(Tree& tree) {
    return tree.nodes[static_cast<std::size_t>(rng_.uniformInt(0, static_cast<int>(tree.nodes.size()) - 1))];
  }

  Node& add(Tree& tree, Node* parent, const Pose& X, std::vector<Pose> edge) {
    tree.nodes.push_back({X, parent, std::move(edge), 0});
    Node& node = tree.nodes.back();
    tree.near->add(&node);
    ++result_.poses;
    if (&tree != &from_start_) return node;
    const Displacement gone = displacement(task_.start, X, world_.center());
    result_.turn = std::max(result_.turn, gone.dr.norm());
    if (farthest_ == nullptr || gone.dp.norm() > result_.way) {
      result_.way = gone.dp.norm();
      farthest_ = &node;
    }
    return node;
  }

  Aim aim(Tree& tree, const GrowingPath& way) {
    if (way.motion == GrowingMotion::anywhere) {
      ob::State* state = si_->allocState();
      sampler_->sampleUniform(state);
      const Pose X = space_->pose(state);
      si_->freeState(state);
      return {&nearest(tree, X), X, {}};
    }
    if (way.motion == GrowingMotion::other_tree) {
      const Pose& X = random_node(other(tree)).X;
      return {&nearest(tree, X), X, {}};
    }
    if (way.motion == GrowingMotion::known_path) {
      const int at = rng_.uniformInt(0, static_cast<int>(task_.known.size()) - 1);
      const Pose& X = task_.known[static_cast<std::size_t>(at)];
      return {&nearest(tree, X), X, {}};
    }
    Node* node = &tree.nodes.back();
    if (rng_.uniform01() >= kNewest)
      for (int i = 0; i < kContest; ++i) {
        Node& rival = random_node(tree);
        if (i == 0 || rival.begun < node->begun) node = &rival;
      }
    const Displacement motion = own_motion(*node, way);
    return {node, displaced(node->X, world_.center(), motion), motion};
  }

  Displacement own_motion(const Node& node, const GrowingPath& way) {
    const double length = range_ * rng_.uniformReal(kShortestMotion, kLongestMotion);
    if (way.motion == GrowingMotion::repeat && node.parent != nullptr) {
      const Displacement d = displacement(node.parent->X, node.X, world_.center());
      double times = length / std::max(distance(node.parent->X, node.X), kMinEdge * world_.radius());
      if (d.dr.norm() > 0) times = std::min(times, kMaxTurn / d.dr.norm());
      return times * d;
    }
    Vec3 axis = Vec3(rng_.gaussian01(), rng_.gaussian01(), rng_.gaussian01()).normalized();
    if (way.axis > 0) axis = Vec3::Unit((way.axis - 1) % 3);
    if (way.axis > 3) axis = node.X.q * axis;
    const double angle = way.sign * std::min(length / world_.gyration(), kMaxTurn);
    if (way.motion == GrowingMotion::turn) return {Vec3::Zero(), angle * axis};
    if (way.motion == GrowingMotion::screw) return {rng_.uniformReal(-1, 1) * length * axis, angle * axis};
    return {way.sign * length * axis, Vec3::Zero()};
  }

  /// Grows a tree; whether that made a path.
  bool iterate(Tree& tree, const Aim& what, const ob::PlannerTerminationCondition& ended) {
    ++result_.iterations;
    Node *begin = what.node, *node = what.node;
    Pose target = what.target;
    bool done = false;
    for (int i = 0; i < kMaxEdges && !done && !ended; ++i) {
      Node* next = world_.size(node->X, target) > 0 ? advance(tree, *node, target, range_) : nullptr;
      if (next != nullptr) {
        node = next;
        done = arrived(tree, *node);
        continue;
      }
      if (!what.again || !in_room(node->X) || made(*begin, *node, *what.again) < kThrough) break;
      begin = node;
      target = displaced(node->X, world_.center(), *what.again);
    }
    if (task_.progress) task_.progress(result_.iterations, result_.poses, result_.way);
    return done;
  }

  /// Leads the part along the path that is known: where that is too near to something it slides beside it.
  bool follow_known(const ob::PlannerTerminationCondition& ended) {
    for (const Pose& X : task_.known) {
      if (ended || result_.iterations >= task_.iterations) return false;
      if (iterate(from_start_, {&nearest(from_start_, X), X, {}}, ended)) return true;
    }
    return false;
  }

  /// Moves the part along what it has in common with others: a screw comes out by turning on with the rise of its
  /// thread, all the way. Of a goal alone that is tried from its side too.
  bool follow_axes(const ob::PlannerTerminationCondition& ended) {
    if (follow_axes(from_start_, ended)) return true;
    return task_.exit == nullptr && follow_axes(from_goals_, ended);
  }
  bool follow_axes(Tree& tree, const ob::PlannerTerminationCondition& ended) {
    Node& root = tree.nodes.front();
    for (const CommonAxis& axis : common_axes(world_.scene(), root.X))
      for (const double sign : {1.0, -1.0}) {
        if (ended || result_.iterations >= task_.iterations) return false;
        if (follow(tree, root, axis, sign, ended)) return true;
      }
    return false;
  }

  /// Moves the part on about an axis, or along it where that has no rise, as far as it comes; whether that made a path.
  bool follow(Tree& tree, Node& root, const CommonAxis& axis, double sign,
              const ob::PlannerTerminationCondition& ended) {
    ++result_.iterations;
    Node* node = &root;
    while (!ended && in_room(node->X)) {
      const Pose target = next_about(axis, node->X, sign);
      Node* next = advance(tree, *node, target, world_.size(node->X, target));
      if (next == nullptr) break;
      const double share = made(*node, *next, displacement(node->X, target, world_.center()));
      node = next;
      if (is_out(tree, *node)) return true;
      if (share < kThrough) break;
      if (task_.progress) task_.progress(result_.iterations, result_.poses, result_.way);
    }
    return node != &root && joined(tree, *node);
  }

  Pose next_about(const CommonAxis& axis, const Pose& X, double sign) const {
    if (axis.rise == 0) return axis.shifted(X, sign * range_);
    const double beside = axis.distance(X, world_.center());
    return axis.turned(X, sign * std::min(kAxisTurn, std::sqrt(8 * kMaxSagitta / std::max(beside, kMaxSagitta))));
  }

  /// How much of a motion a part that was led by it has made.
  double made(const Node& from, const Node& to, const Displacement& motion) const {
    const Displacement d = displacement(from.X, to.X, world_.center());
    const double turns = world_.gyration() * world_.gyration();
    return (d.dp.dot(motion.dp) + turns * d.dr.dot(motion.dr)) /
           (motion.dp.squaredNorm() + turns * motion.dr.squaredNorm());
  }

  bool in_room(const Pose& X) const {
    const Vec3 c = X * world_.center();
    return (c.array() >= task_.room.low.array()).all() && (c.array() <= task_.room.high.array()).all();
  }

  /// One edge from a node towards a pose, no longer than `longest`; null when it would be too short.
  Node* advance(Tree& tree, Node& from, const Pose& target, double longest) {
    ++from.begun;
    const double length = world_.size(from.X, target);
    const Pose next = world_.along(from.X, target, length <= longest ? 1 : longest / length);
    const double share = world_.free_share(from.X, next);
    std::vector<Pose> edge = {world_.along(from.X, next, share)};
    if (share < 1) {
      if (&tree == &from_start_ && world_.blocker()) ++result_.stops[*world_.blocker()];
      comply(from.X, target, edge);
    }
    const Pose X = edge.back();
    if (world_.size(from.X, X) < kMinEdge * world_.radius()) return nullptr;
    // Where the tree has been, it goes on from there: along a slot or a thread it comes by the same poses again and
    // again.
    Node& known = nearest(tree, X);
    if (distance(known.X, X) < kSame * world_.radius()) return &known == &from ? nullptr : &known;
    return &add(tree, &from, X, std::move(edge));
  }

  /// Leads the contact loop on from the end of an edge that was stopped there.
  void comply(const Pose& from, const Pose& target, std::vector<Pose>& edge) {
    world_.comply(edge.back(), target, range_, pieces_);
    if (pieces_.empty()) return;
    if (world_.is_free(from, pieces_.back())) edge.clear();
    const std::size_t first = edge.empty() ? pieces_.size() - 1 : 0;
    edge.insert(edge.end(), pieces_.begin() + static_cast<std::ptrdiff_t>(first), pieces_.end());
  }

  /// Whether a new node completes a path.
  bool arrived(Tree& tree, Node& node) { return is_out(tree, node) || joined(tree, node); }

  bool is_out(const Tree& tree, const Node& node) {
    if (&tree != &from_start_ || task_.exit == nullptr || !task_.exit->is_out(node.X)) return false;
    result_.path = path_to(&node);
    return true;
  }

  bool joined(Tree& tree, Node& node) {
    Node& there = nearest(other(tree), node.X);
    if (world_.size(node.X, there.X) > kJoinReach * range_ || !world_.is_free(node.X, there.X)) return false;
    const bool forward = &tree == &from_start_;
    result_.path = path_to(forward ? &node : &there);
    std::vector<Pose> rest = path_to(forward ? &there : &node);
    result_.path.insert(result_.path.end(), rest.rbegin(), rest.rend());
    return true;
  }

  /// From the root to a node.
  static std::vector<Pose> path_to(const Node* node) {
    std::vector<Pose> backwards;
    for (; node->parent != nullptr; node = node->parent)
      backwards.insert(backwards.end(), node->edge.rbegin(), node->edge.rend());
    backwards.push_back(node->X);
    return {backwards.rbegin(), backwards.rend()};
  }

  ob::PlannerStatus finish() {
    result_.found = true;
    auto path = std::make_shared<og::PathGeometric>(si_);
    ob::State* state = si_->allocState();
    for (const Pose& X : result_.path) {
      space_->set(state, X);
      path->append(state);
    }
    si_->freeState(state);
    pdef_->addSolutionPath(path, false, 0, getName());
    return ob::PlannerStatus::EXACT_SOLUTION;
  }

  std::shared_ptr<PoseSpace> space_;
  MotionWorld& world_;
  const SearchTask& task_;
  SearchResult& result_;
  const double range_;
  ob::StateSamplerPtr sampler_;
  ompl::RNG rng_;
  Tree from_start_, from_goals_;
  Node probe_;
  Node* farthest_ = nullptr;
  std::vector<Pose> pieces_;
};

}  // namespace

ob::PlannerPtr compliant_connect(const ob::SpaceInformationPtr& si, std::shared_ptr<PoseSpace> space,
                                 MotionWorld& world, const SearchTask& task, SearchResult& result) {
  return std::make_shared<CompliantConnect>(si, std::move(space), world, task, result);
}

}  // namespace tegotae
