#include "narrowphase/patch_clusters.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tegotae {
namespace {

/// A round of merging that joins less than one cluster in so many goes on with pairs that are best for one side only.
constexpr std::size_t kSlowRound = 12;
/// An edge is sharp where its faces turn by more than 14°, less than a chamfer against a thread's flank and more than
/// the facets of most curved walls. Joining over nothing but sharp edges costs so many times as much: a patch stays on
/// one flank of a thread for longer, and then is a curve without a thickness about the thread's axis.
constexpr float kSharpCosine = 0.9703f, kSharpWorth = 3;

/// Thickness + kDiameterWeight · diameter of the two sets together. A uniform slab of thickness t has the variance
/// t²/12 across. The least eigenvalue is taken as det / (sum of the principal minors), exact for a thin set and a
/// third for a ball.
float joint_cost(const PatchMoments& m, const PatchMoments& o) {
  const double i = 1 / (m.w + o.w), mx = (m.x + o.x) * i, my = (m.y + o.y) * i, mz = (m.z + o.z) * i;
  const double a = (m.xx + o.xx) * i - mx * mx, b = (m.yy + o.yy) * i - my * my, c = (m.zz + o.zz) * i - mz * mz;
  const double d = (m.xy + o.xy) * i - mx * my, e = (m.xz + o.xz) * i - mx * mz, f = (m.yz + o.yz) * i - my * mz;
  const double minors = a * b - d * d + a * c - e * e + b * c - f * f;
  const double det = a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e);
  const double thin = minors > 0 ? std::max(det, 0.0) / minors : 0.0;
  return static_cast<float>(std::sqrt(12 * thin) + kDiameterWeight * std::sqrt(12 * std::max(a + b + c, 0.0)));
}

/// Clusters faces from the bottom by mutual best neighbors.
class Clustering {
 public:
  Clustering(const TriangleMesh& mesh, const std::vector<PatchItem>& items) : joins_(items.size()) {
    joins_.reserve(2 * items.size());
    moments_.reserve(2 * items.size());
    for (const PatchItem& t : items) moments_.push_back(PatchMoments::of(t));
    active_.resize(items.size());
    std::iota(active_.begin(), active_.end(), 0u);
    link_faces(mesh, items);
    while (!links_.empty()) round();
    std::vector<std::uint32_t> roots = active_;
    root_ = join_apart(roots.data(), roots.data() + roots.size());
  }

  PatchClusters take() { return {std::move(joins_), std::move(moments_), root_}; }

 private:
  /// Neighbors, as places in active_, and whether all edges between them are sharp.
  struct Link {
    std::uint32_t u, v : 31, sharp : 1;
    float cost;
  };
  static constexpr float kUnknown = -1;
  /// The bits of a place in active_, and the one that marks that of a new round whose cluster is unchanged.
  static constexpr std::uint32_t kPlace = 0x7fffffffu, kKept = ~kPlace;

  /// Faces that share an edge: half-edges sorted by their lesser vertex, matched by the other one.
  void link_faces(const TriangleMesh& mesh, const std::vector<PatchItem>& items) {
    std::vector<std::uint32_t> begin(mesh.vertices.size() + 1, 0);
    auto each = [&](auto f) {
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
          const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
          if (a != b) f(std::min(a, b), std::max(a, b), t);
        }
      }
    };
    each([&](std::uint32_t a, std::uint32_t, std::uint32_t) { ++begin[a + 1]; });
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    struct Half {
      std::uint32_t other, face;
    };
    std::vector<Half> half(begin.back());
    std::vector<std::uint32_t> place(begin.begin(), begin.end() - 1);
    each([&](std::uint32_t a, std::uint32_t b, std::uint32_t t) { half[place[a]++] = {b, t}; });
    links_.reserve(half.size() / 2 + 1);
    for (std::size_t a = 0; a + 1 < begin.size(); ++a) {
      const auto from = half.begin() + begin[a], to = half.begin() + begin[a + 1];
      std::sort(from, to,
                [](const Half& x, const Half& y) { return x.other != y.other ? x.other < y.other : x.face < y.face; });
      for (auto h = from; h != to && h + 1 != to; ++h) {
        if (h[0].other != h[1].other || h[0].face == h[1].face) continue;
        // Whatever the way that the faces are wound.
        const float cosine = std::abs(items[h[0].face].normal.dot(items[h[1].face].normal));
        links_.push_back({h[0].face, h[1].face & kPlace, cosine < kSharpCosine, kUnknown});
      }
    }
  }

  float cost(const Link& l) const {
    const float joint = joint_cost(moments_[active_[l.u]], moments_[active_[l.v]]);
    return l.sharp ? kSharpWorth * joint : joint;
  }

  void round() {
    const std::size_t n = active_.size();
    best_.assign(n, kNoCluster);
    best_cost_.assign(n, std::numeric_limits<float>::infinity());
    best_key_.assign(n, 0);
    for (Link& l : links_) {
      if (l.cost < 0) l.cost = cost(l);
      // Regular meshes are full of ties; a scattered order breaks them in many places at once.
      const std::uint32_t key = (std::min(l.u, l.v) * 2654435761u) ^ (std::max(l.u, l.v) * 2246822519u);
      auto offer = [&](std::uint32_t u, std::uint32_t v) {
        if (l.cost > best_cost_[u] || (l.cost == best_cost_[u] && key <= best_key_[u])) return;
        best_cost_[u] = l.cost;
        best_key_[u] = key;
        best_[u] = v;
      };
      offer(l.u, l.v);
      offer(l.v, l.u);
    }
    renamed_.assign(n, kNoCluster);
    next_.clear();
    std::size_t joined = 0;
    for (std::uint32_t u = 0; u < n; ++u) {
      const std::uint32_t v = best_[u];
      if (v != kNoCluster && u < v && best_[v] == u) join(u, v), ++joined;
    }
    if (joined * kSlowRound < n) {
      for (std::uint32_t u = 0; u < n; ++u) {
        const std::uint32_t v = best_[u];
        if (v != kNoCluster && renamed_[u] == kNoCluster && renamed_[v] == kNoCluster) join(u, v);
      }
    }
    for (std::uint32_t u = 0; u < n; ++u) {
      if (renamed_[u] != kNoCluster) continue;
      renamed_[u] = static_cast<std::uint32_t>(next_.size()) | kKept;
      next_.push_back(active_[u]);
    }
    active_.swap(next_);
    relink();
  }

  void join(std::uint32_t u, std::uint32_t v) {
    renamed_[u] = renamed_[v] = static_cast<std::uint32_t>(next_.size());
    next_.push_back(add(active_[u], active_[v]));
  }

  std::uint32_t add(std::uint32_t left, std::uint32_t right) {
    joins_.push_back({left, right, joins_[left].faces + joins_[right].faces});
    PatchMoments m = moments_[left];
    moments_.push_back(m += moments_[right]);
    return static_cast<std::uint32_t>(joins_.size() - 1);
  }

  /// Renames the ends of the links, drops those inside a cluster and all but one between two clusters, which is sharp
  /// where all of them are.
  void relink() {
    std::size_t kept = 0;
    first_.assign(active_.size() + 1, 0);
    for (const Link& l : links_) {
      const std::uint32_t u = renamed_[l.u], v = renamed_[l.v];
      const std::uint32_t pu = u & kPlace, pv = v & kPlace;
      if (pu == pv) continue;
      links_[kept++] = {std::min(pu, pv), std::max(pu, pv) & kPlace, l.sharp, (u & v & kKept) ? l.cost : kUnknown};
      ++first_[std::min(pu, pv) + 1];
    }
    links_.resize(kept);
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    sorted_.resize(kept);
    for (const Link& l : links_) sorted_[first_[l.u]++] = l;
    // Where in links_ the link of a cluster with the last one of lesser number is.
    place_.assign(active_.size(), kNoCluster);
    kept = 0;
    for (const Link& l : sorted_) {
      if (const std::uint32_t place = place_[l.v]; place < kept && links_[place].u == l.u) {
        links_[place].sharp &= l.sharp;
        continue;
      }
      place_[l.v] = static_cast<std::uint32_t>(kept);
      links_[kept++] = l;
    }
    links_.resize(kept);
  }

  /// Joins clusters that share no edge, by halving their centers along the longest side.
  std::uint32_t join_apart(std::uint32_t* begin, std::uint32_t* end) {
    if (end - begin == 1) return *begin;
    Vec3 lo = center(*begin), hi = lo;
    for (const std::uint32_t* c = begin; c != end; ++c) {
      lo = lo.cwiseMin(center(*c));
      hi = hi.cwiseMax(center(*c));
    }
    int axis = 0;
    (hi - lo).maxCoeff(&axis);
    std::uint32_t* middle = begin + (end - begin) / 2;
    std::nth_element(begin, middle, end, [&](std::uint32_t a, std::uint32_t b) {
      const double x = center(a)[axis], y = center(b)[axis];
      return x != y ? x < y : a < b;
    });
    const std::uint32_t left = join_apart(begin, middle), right = join_apart(middle, end);
    return add(left, right);
  }

  Vec3 center(std::uint32_t cluster) const {
    const PatchMoments& m = moments_[cluster];
    return Vec3(m.x, m.y, m.z) / m.w;
  }

  std::vector<PatchJoin> joins_;
  std::vector<PatchMoments> moments_;
  std::vector<std::uint32_t> active_, next_, renamed_, best_, best_key_, first_, place_;
  std::vector<float> best_cost_;
  std::vector<Link> links_, sorted_;
  std::uint32_t root_ = 0;
};

}  // namespace

PatchClusters cluster_patches(const TriangleMesh& mesh, const std::vector<PatchItem>& items) {
  return Clustering(mesh, items).take();
}

}  // namespace tegotae
