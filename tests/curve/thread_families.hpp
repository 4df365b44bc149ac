#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "models/helical.hpp"
#include "models/threaded.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae::test {

/// Random screws and nuts that fit each other, about z: coarse and fine facets, few and many pitches, several starts,
/// both hands, chamfers, run-outs, shanks, heads, and threads whose mesh knows nothing of their helix.
struct ThreadedPair {
  TriangleMesh screw, nut;
  double lead = 0;  ///< rise of a turn, m; negative for a left-hand thread
  std::string what;
};

class ThreadFamily {
 public:
  explicit ThreadFamily(unsigned seed) : rng_(seed) {}

  ThreadedPair next() { return one_in(3) ? wavy() : metric(); }

  bool one_in(unsigned n) { return rng_() % n == 0; }
  double between(double a, double b) { return a + (b - a) * std::uniform_real_distribution<double>(0, 1)(rng_); }
  int between(int a, int b) { return a + static_cast<int>(rng_() % static_cast<unsigned>(b - a + 1)); }
  Vec3 vector(double most) {
    const double x = between(-most, most), y = between(-most, most), z = between(-most, most);
    return {x, y, z};
  }
  /// Faces in another order.
  TriangleMesh shuffled(TriangleMesh mesh) {
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), rng_);
    return mesh;
  }
  /// A soup of separate triangles, some of them gone, turned over, repeated, without an area.
  TriangleMesh soiled(const TriangleMesh& clean) {
    TriangleMesh soup;
    for (const auto& t : clean.triangles) {
      if (one_in(8)) continue;
      for (int copies = one_in(12) ? 2 : 1; copies > 0; --copies) {
        const auto first = static_cast<std::uint32_t>(soup.vertices.size());
        for (const std::uint32_t v : t) soup.vertices.push_back(clean.vertices[v]);
        const bool over = one_in(4);
        soup.triangles.push_back({first, first + (over ? 2 : 1), first + (over ? 1 : 2)});
        if (one_in(9)) soup.triangles.push_back({first, first, first + 1});
      }
    }
    return soup;
  }

 private:
  ThreadedPair metric() {
    shapes::Bolt b;
    shapes::Thread& t = b.thread;
    t.segments = 6 * between(4, 33);
    t.rows = between(1, 6);
    t.starts = one_in(3) ? between(2, 4) : 1;
    t.left_hand = one_in(3);
    t.diameter = 0.016;
    t.pitch = t.diameter * between(0.04, 0.2) / std::sqrt(t.starts);
    const double lead = t.pitch * t.starts;
    b.length = std::max(between(0.6, 3.0) * t.diameter, 3 * lead);
    if (one_in(3)) b.shank = between(0.1, 0.5) * b.length;
    if (one_in(2)) b.runout = between(0.3, 2.0) * t.pitch;
    if (b.length - b.shank - b.runout < 1.5 * t.pitch) b.shank = b.runout = 0;
    if (!one_in(3)) b.chamfer = std::min(0.003, between(0.1, 1.0) * t.pitch);
    b.head_width = between(1.3, 2.0) * t.diameter;
    b.head_height = between(0.3, 1.0) * t.diameter;
    shapes::Nut n;
    n.thread = t;
    if (one_in(2)) n.thread.segments = 6 * between(4, 33), n.thread.rows = between(1, 6);
    n.height = std::max(between(0.4, 1.2) * t.diameter, 1.5 * t.pitch);
    n.width = b.head_width;
    n.chamfer = std::min({b.chamfer, 0.2 * n.height, (0.94 * n.width - t.diameter) / 2});
    n.play = between(0.005, 0.1) * t.pitch;
    return {shapes::bolt(b), shapes::nut(n), t.left_hand ? -lead : lead,
            "metric, " + std::to_string(t.segments) + " and " + std::to_string(n.thread.segments) + " segments, " +
                std::to_string(t.starts) + " starts, pitch " + std::to_string(1e3 * t.pitch) + " mm, chamfer " +
                std::to_string(1e3 * b.chamfer) + " mm"};
  }

  ThreadedPair wavy() {
    shapes::WavyThread t;
    t.radius = 0.008;
    t.depth = t.radius * between(0.05, 0.25);
    t.pitch = t.depth * between(1.2, 3.0);
    t.segments = between(24, 120);
    t.rings = between(8, 24);
    t.low = -t.pitch * between(2.5, 8.0);
    shapes::WavyThread inner = t;
    inner.radius += 0.1 * t.depth;
    inner.segments = between(24, 120);
    inner.rings = between(8, 24);
    ThreadedPair out{shapes::screw(t), shapes::nut(inner, inner.radius + inner.depth + between(0.1, 0.5) * t.radius),
                     t.pitch,
                     "wavy, " + std::to_string(t.segments) + " and " + std::to_string(inner.segments) +
                         " segments, pitch " + std::to_string(1e3 * t.pitch) + " mm"};
    if (!one_in(3)) return out;
    out.lead = -out.lead;
    for (TriangleMesh* m : {&out.screw, &out.nut}) {
      for (Vec3& v : m->vertices) v.x() = -v.x();
      for (auto& f : m->triangles) std::swap(f[0], f[1]);
    }
    return out;
  }

  std::mt19937 rng_;
};

}  // namespace tegotae::test
