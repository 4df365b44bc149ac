#include "narrowphase/self_contact.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>

#include "core/numbers.hpp"
#include "core/parallel_for.hpp"
#include "narrowphase/patch_separate.hpp"

namespace tegotae {
namespace {

using Triangle = std::array<Vec3, 3>;

/// Faces that a thread looks at before it asks for more.
constexpr std::uint32_t kAtOnce = 2048;
/// Normals around a corner that all have this much along their mean leave no doubt that none is turned away from it.
constexpr double kUpright = 0.05;
/// So many pairs of the faces around a corner are looked at (in a second); more count as meeting.
constexpr std::size_t kMostAround = 1u << 20;
/// Normals of faces around a corner that are in one run have this much along the first of them. A run goes round by
/// less than this (rad).
constexpr double kSameRun = 0.5, kNearlyRound = 6.2;
/// Two faces of an edge that are folded onto each other to less than 0.8 degrees count as meeting.
constexpr double kFolded = 0.9999;
/// Corners are beside a plane from this share of the mesh's radius on.
constexpr double kBeside = 1e-9;
/// Of the extents of a box, whose axes are unit vectors up to single precision.
constexpr double kBoxSlack = 1e-6;

class SelfContact {
 public:
  SelfContact(const PatchTree& tree, const Topology& topology)
      : tree_(tree),
        topology_(topology),
        still_(Pose{}, {}, Vec3::Zero(), tree, tree.radius(), 0),
        common_(common_corners()) {}

  bool any() {
    const auto faces = static_cast<std::uint32_t>(tree_.order().size());
    const auto corners = static_cast<std::uint32_t>(tree_.mesh().vertices.size());
    in_pieces(faces, [this](std::uint32_t face) { return is_thin(face); });
    in_pieces(corners, [this](std::uint32_t v) { return !is_plain(v) && star_meets(v); });
    in_pieces(faces, [this](std::uint32_t face) { return meets_others(face); });
    return found_;
  }

 private:
  template <typename Ask>
  void in_pieces(std::uint32_t n, Ask ask) {
    parallel_for(static_cast<int>((n + kAtOnce - 1) / kAtOnce), 0,
                 [&](int piece) {
                   const std::uint32_t from = static_cast<std::uint32_t>(piece) * kAtOnce;
                   for (std::uint32_t i = from; i < std::min(n, from + kAtOnce) && !found_; ++i)
                     if (ask(i)) found_ = true;
                 },
                 {});
  }

  using Corners = std::array<std::uint32_t, 3>;  ///< of the mesh, kNone after the last
  static constexpr std::uint32_t kNone = 0xffffffffu;

  static bool has(const Corners& corners, std::uint32_t v) {
    return std::find(corners.begin(), corners.end(), v) != corners.end();
  }

  static Corners both(const Corners& a, const Corners& b) {
    Corners out{kNone, kNone, kNone};
    std::copy_if(a.begin(), a.end(), out.begin(), [&](std::uint32_t v) { return v != kNone && has(b, v); });
    return out;
  }

  /// For each node the corners that all faces under it have: the middle of a fan.
  std::vector<Corners> common_corners() const {
    const auto& nodes = tree_.nodes();
    std::vector<Corners> out(nodes.size());
    const auto of_face = [&](std::uint32_t place) -> Corners {
      const auto& t = tree_.mesh().triangles[tree_.order()[place]];
      return {t[0], t[1], t[2]};
    };
    // Children come after their node.
    for (std::size_t i = nodes.size(); i-- > 0;) {
      const PatchNode& node = nodes[i];
      out[i] = node.leaf() ? of_face(node.first) : both(out[node.first], out[node.first + 1]);
      if (!node.leaf()) continue;
      for (std::uint32_t k = node.first + 1; k < node.first + node.count; ++k) out[i] = both(out[i], of_face(k));
    }
    return out;
  }

  Triangle triangle(std::uint32_t face) const {
    return {tree_.corner(face, 0), tree_.corner(face, 1), tree_.corner(face, 2)};
  }
  static Vec3 normal(const Triangle& t) { return (t[1] - t[0]).cross(t[2] - t[0]).normalized(); }

  bool is_thin(std::uint32_t face) const {
    const Triangle t = triangle(face);
    const double longest2 =
        std::max({(t[1] - t[0]).squaredNorm(), (t[2] - t[1]).squaredNorm(), (t[0] - t[2]).squaredNorm()});
    return !((t[1] - t[0]).cross(t[2] - t[0]).norm() > kThinFace * longest2);
  }

  /// Whether the faces around the corner are plainly a disk: seen along the mean of their normals they all face the
  /// viewer and go round once, so that they meet only in the edges that they share.
  bool is_plain(std::uint32_t v) const {
    const std::uint32_t begin = topology_.vertex_face_begin[v], end = topology_.vertex_face_begin[v + 1];
    Vec3 mean = Vec3::Zero();
    for (std::uint32_t i = begin; i < end; ++i) mean += normal(triangle(topology_.vertex_faces[i]));
    if (!(mean.norm() > 0)) return begin == end;
    mean.normalize();
    const Vec3 x = mean.cross(std::abs(mean.x()) < 0.7 ? Vec3::UnitX() : Vec3::UnitY()).normalized();
    const Vec3 y = mean.cross(x);
    int around = 0;
    for (std::uint32_t i = begin; i < end; ++i) {
      const std::uint32_t face = topology_.vertex_faces[i];
      if (!(normal(triangle(face)).dot(mean) > kUpright)) return false;
      const auto& t = tree_.mesh().triangles[face];
      const std::size_t k = t[0] == v ? 0 : t[1] == v ? 1 : 2;
      const Vec3& p = tree_.mesh().vertices[v];
      const Vec3 first = tree_.mesh().vertices[t[(k + 1) % 3]] - p, last = tree_.mesh().vertices[t[(k + 2) % 3]] - p;
      // The direction x is in the sector from the first edge, which is in it, to the last.
      around += y.dot(first) <= 0 && y.dot(last) > 0 && x.dot(first) * y.dot(last) > x.dot(last) * y.dot(first);
    }
    return around == 1;
  }

  /// The faces around a corner in runs of neighbors that meet only in the edges that they share: seen along the normal
  /// of the first they all face the viewer, and go round less than once. Such a run is a fan of any number of needles.
  /// Each face's number in `faces` has the number of its run; faces whose neighbors are not known are alone.
  std::vector<std::uint32_t> runs(std::uint32_t v, const std::vector<std::uint32_t>& faces) const {
    struct Sector {
      std::uint32_t first, last, face;  // corners of the mesh, number in `faces`
    };
    std::vector<Sector> by_first;
    for (std::uint32_t i = 0; i < faces.size(); ++i) {
      const auto& t = tree_.mesh().triangles[faces[i]];
      const std::size_t k = t[0] == v ? 0 : t[1] == v ? 1 : 2;
      by_first.push_back({t[(k + 1) % 3], t[(k + 2) % 3], i});
    }
    std::sort(by_first.begin(), by_first.end(), [](const Sector& a, const Sector& b) { return a.first < b.first; });
    const auto next = [&](std::uint32_t corner) -> const Sector* {
      const auto at = std::lower_bound(by_first.begin(), by_first.end(), corner,
                                       [](const Sector& s, std::uint32_t c) { return s.first < c; });
      const bool one =
          at != by_first.end() && at->first == corner && (at + 1 == by_first.end() || (at + 1)->first != corner);
      return one ? &*at : nullptr;
    };
    std::vector<std::uint32_t> run(faces.size(), kNone);
    std::uint32_t count = 0;
    for (const Sector& start : by_first) {
      if (run[start.face] != kNone) continue;
      Vec3 toward = Vec3::Zero();
      double turned = 2 * kPi;
      for (const Sector* s = &start; s != nullptr && run[s->face] == kNone; s = next(s->last)) {
        const Vec3 n = normal(triangle(faces[s->face]));
        double angle = sector_angle(v, s->first, s->last, toward);
        if (!(n.dot(toward) > kSameRun && turned + angle < kNearlyRound)) {
          toward = n;
          turned = 0;
          angle = sector_angle(v, s->first, s->last, toward);
          ++count;
        }
        turned += angle;
        run[s->face] = count - 1;
      }
    }
    return run;
  }

  /// From one edge at the corner to the other, seen along `toward`.
  double sector_angle(std::uint32_t v, std::uint32_t first, std::uint32_t last, const Vec3& toward) const {
    const auto& points = tree_.mesh().vertices;
    const auto flat = [&](const Vec3& edge) -> Vec3 { return edge - edge.dot(toward) * toward; };
    const Vec3 a = flat(points[first] - points[v]), b = flat(points[last] - points[v]);
    return std::atan2(toward.dot(a.cross(b)), a.dot(b));
  }

  bool star_meets(std::uint32_t v) const {
    const std::uint32_t begin = topology_.vertex_face_begin[v], end = topology_.vertex_face_begin[v + 1];
    const std::vector<std::uint32_t> faces(topology_.vertex_faces.begin() + begin,
                                           topology_.vertex_faces.begin() + end);
    const std::vector<std::uint32_t> run = runs(v, faces);
    std::vector<std::uint32_t> by_run(faces.size());
    std::iota(by_run.begin(), by_run.end(), 0U);
    std::stable_sort(by_run.begin(), by_run.end(), [&](std::uint32_t i, std::uint32_t k) { return run[i] < run[k]; });
    std::size_t asked = 0, others = 0;
    for (std::size_t i = 0; i < by_run.size(); ++i) {
      while (others < by_run.size() && run[by_run[others]] == run[by_run[i]]) ++others;
      for (std::size_t k = others; k < by_run.size(); ++k)
        if (++asked > kMostAround || neighbors_meet(faces[by_run[i]], faces[by_run[k]])) return true;
    }
    return false;
  }

  bool neighbors_meet(std::uint32_t f, std::uint32_t g) const {
    const auto &s = tree_.mesh().triangles[f], &t = tree_.mesh().triangles[g];
    std::array<std::size_t, 3> of_f{}, of_g{};  // shared corners first
    std::size_t shared = 0, last_f = 3, last_g = 3;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        if (s[i] == t[k]) of_f[shared] = i, of_g[shared] = k, ++shared;
    if (shared > 2) return true;
    const Triangle a = triangle(f), b = triangle(g);
    if (shared == 2) {
      last_f = 3 - of_f[0] - of_f[1];
      last_g = 3 - of_g[0] - of_g[1];
      const Vec3 edge = (a[of_f[1]] - a[of_f[0]]).normalized(), p = a[last_f] - a[of_f[0]], q = b[last_g] - a[of_f[0]];
      return !((p - p.dot(edge) * edge).normalized().dot((q - q.dot(edge) * edge).normalized()) < kFolded);
    }
    // Where they meet beyond the corner they do so along a line that ends at the edge across it of one of them.
    const auto across = [](const Triangle& c, std::size_t corner) {
      return Triangle{c[(corner + 1) % 3], c[(corner + 2) % 3], c[(corner + 2) % 3]};
    };
    return !apart(across(a, of_f[0]), b) || !apart(across(b, of_g[0]), a);
  }

  bool apart(const Triangle& a, Triangle b) const {
    for (Vec3& v : b) v -= tree_.origin();
    MovingPlane plane{Vec3::Zero(), Vec3::Zero()};
    return separate_triangles(a, b, still_, tree_.radius(), nullptr, plane);
  }

  /// Whether all of `b` is on one side of the plane of `a`.
  bool beside(const Triangle& a, const Triangle& b) const {
    const Vec3 n = normal(a);
    const double x = n.dot(b[0] - a[0]), y = n.dot(b[1] - a[0]), z = n.dot(b[2] - a[0]);
    const double least = kBeside * tree_.radius();
    return std::min({x, y, z}) > least || std::max({x, y, z}) < -least;
  }

  /// Faces with a higher number that share no corner.
  bool meets_others(std::uint32_t face) const {
    const auto& t = tree_.mesh().triangles[face];
    const Triangle a = triangle(face);
    const Vec3 n = normal(a);
    std::array<std::uint32_t, 128> stack;
    std::size_t count = 0;
    stack[count++] = 0;
    while (count > 0) {
      const std::uint32_t id = stack[--count];
      const PatchNode& node = tree_.nodes()[id];
      // Each face of a fan would look at all the others.
      const Corners& common = common_[id];
      if (has(common, t[0]) || has(common, t[1]) || has(common, t[2])) continue;
      if (!may_reach(node, a, n)) continue;
      if (!node.leaf()) {
        if (count + 2 > stack.size()) return true;
        stack[count++] = node.first;
        stack[count++] = node.first + 1;
        continue;
      }
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        const std::uint32_t other = tree_.order()[i];
        const auto& u = tree_.mesh().triangles[other];
        const bool shares =
            std::any_of(t.begin(), t.end(), [&](std::uint32_t v) { return v == u[0] || v == u[1] || v == u[2]; });
        if (other <= face || shares) continue;
        const Triangle b = triangle(other);
        if (!beside(a, b) && !beside(b, a) && !apart(a, b)) return true;
      }
    }
    return false;
  }

  /// Whether the triangle may reach into the box: by the box's own directions and the triangle's normal.
  bool may_reach(const PatchNode& node, const Triangle& a, const Vec3& n) const {
    const Vec3 center = node.center_vec() + tree_.origin();
    const std::array<Vec3, 3> v = {a[0] - center, a[1] - center, a[2] - center};
    const double slack = kBoxSlack * (double{node.half[0]} + node.half[1] + node.half[2]) + kBeside * tree_.radius();
    double across = slack;
    for (int i = 0; i < 3; ++i) {
      const Vec3 axis = node.axis_vec(i);
      const double x = axis.dot(v[0]), y = axis.dot(v[1]), z = axis.dot(v[2]);
      const double half = node.half[static_cast<std::size_t>(i)];
      if (std::min({x, y, z}) > half + slack || std::max({x, y, z}) < -half - slack) return false;
      across += half * std::abs(axis.dot(n));
    }
    return std::abs(n.dot(v[0])) <= across;
  }

  const PatchTree& tree_;
  const Topology& topology_;
  const Sweep still_;  ///< of the mesh in its own file frame: no motion
  const std::vector<Corners> common_;
  std::atomic<bool> found_{false};
};

}  // namespace

bool meets_itself(const PatchTree& tree, const Topology& topology) {
  return SelfContact(tree, topology).any();
}

}  // namespace tegotae
