#include "curve/axis_refine.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <map>
#include <tuple>

#include "core/numbers.hpp"

namespace tegotae {
namespace {

/// Facets that are used, rounds, and the size of the cells of the profile (of the mesh's size) and of its normals.
constexpr std::size_t kMaxUsed = 4000;
constexpr int kRefineRounds = 6, kNormalCells = 24;
constexpr double kCell = 0.02;
/// A rise that is only rounding, of the size.
constexpr double kNoRise = 1e-10;
/// The rise is looked for within this part of itself, in so many steps for a turn of the thread, among so many corners
/// of facets that lean along the axis by this (cosine in the profile), and taken where it lays them so much better.
constexpr double kWindow = 0.08, kStepsPerTurn = 24, kLeaning = 0.3, kBetter = 1.05;
constexpr std::size_t kMaxLaid = 1500, kHarmonics = 4;
/// Keeps what the facets leave open where it is, relative to the trace.
constexpr double kDamping = 1e-9;
/// Changes of the axis beyond this say that the facets are not a screw surface.
constexpr double kMaxChange = 0.1;

using Vec5 = Eigen::Matrix<double, 5, 1>;
using Mat5 = Eigen::Matrix<double, 5, 5>;

struct Frame {
  Vec3 e1, e2, c, p;
  double rise;

  explicit Frame(const ScrewMotion& m) : c(m.c), p(m.axis_point()), rise(std::abs(m.rise()) < kNoRise ? 0 : m.rise()) {
    e1 = c.unitOrthogonal();
    e2 = c.cross(e1);
  }
  Vec3 local(const Vec3& x) const { return Vec3((x - p).dot(e1), (x - p).dot(e2), (x - p).dot(c)); }
};

/// A corner in profile coordinates, with the normal of its facet there.
struct Sample {
  std::tuple<int, int, int> cell;
  double r, w, nr, nw, area;
  double cos, sin, z, phi;  ///< φ of the turn that w is of
};

std::vector<Sample> samples_of(const std::vector<Facet>& facets, const std::vector<std::size_t>& of, const Frame& f) {
  std::vector<Sample> out;
  const std::size_t stride = std::max<std::size_t>(1, of.size() / kMaxUsed);
  for (std::size_t i = 0; i < of.size(); i += stride) {
    const Facet& t = facets[of[i]];
    const Vec3 middle = f.local(t.center);
    const double rm = middle.head<2>().norm();
    if (!(rm > 0)) continue;
    const Vec3 n(t.normal.dot(f.e1), t.normal.dot(f.e2), t.normal.dot(f.c));
    double nr = (n.x() * middle.x() + n.y() * middle.y()) / rm, nw = n.z();
    const double length = std::hypot(nr, nw);
    if (!(length > 0.5)) continue;
    // Both senses of a normal are one.
    if (nw < 0 || (nw == 0 && nr < 0)) nr = -nr, nw = -nw;
    nr /= length;
    nw /= length;
    const int turn = static_cast<int>(std::lround(std::atan2(nw, nr) / kPi * kNormalCells)) % kNormalCells;
    for (const Vec3& x : t.corner) {
      const Vec3 q = f.local(x);
      Sample s;
      s.r = q.head<2>().norm();
      if (!(s.r > 0)) continue;
      s.cos = q.x() / s.r;
      s.sin = q.y() / s.r;
      s.z = q.z();
      s.phi = std::atan2(q.y(), q.x());
      s.w = s.z - f.rise * s.phi;
      if (f.rise != 0) {
        const double pitch = 2 * kPi * f.rise, turns = std::floor(s.w / pitch);
        s.w -= pitch * turns;
        s.phi += 2 * kPi * turns;
      }
      s.nr = nr;
      s.nw = nw;
      s.area = t.area;
      s.cell = {static_cast<int>(std::floor(s.r / kCell)), static_cast<int>(std::floor(s.w / kCell)), turn};
      out.push_back(s);
    }
  }
  std::sort(out.begin(), out.end(), [](const Sample& a, const Sample& b) {
    return std::tie(a.cell, a.phi, a.r, a.z) < std::tie(b.cell, b.phi, b.r, b.z);
  });
  return out;
}

/// Least squares of how far the corners of a cell lie off their common line, over all cells.
class Equations {
 public:
  Equations(const std::vector<Sample>& samples, double rise, double scale) : rise_(rise), scale_(scale) {
    for (std::size_t i = 0, j = 0; i < samples.size(); i = j) {
      while (j < samples.size() && samples[j].cell == samples[i].cell) ++j;
      if (j - i >= 4) add_cell(samples, i, j);
    }
  }

  Vec5 solve() const {
    const Mat5 damped = A_ + kDamping * A_.trace() * Mat5::Identity();
    return damped.ldlt().solve(b_);
  }
  double rms() const { return weight_ > 0 ? std::sqrt(square_ / weight_) : 0; }

 private:
  void add_cell(const std::vector<Sample>& samples, std::size_t begin, std::size_t end) {
    double nr = 0, nw = 0;
    for (std::size_t i = begin; i < end; ++i) {
      // In one cell of normals, but perhaps around the turn.
      const double sign = nr * samples[i].nr + nw * samples[i].nw < 0 ? -1 : 1;
      nr += sign * samples[i].area * samples[i].nr;
      nw += sign * samples[i].area * samples[i].nw;
    }
    const double length = std::hypot(nr, nw);
    if (!(length > 0)) return;
    nr /= length;
    nw /= length;
    std::vector<double> weight(end - begin);
    double mean = middle(samples, begin, end, nr, nw), g_mean = 0, sum = 0;
    Vec5 j_mean = Vec5::Zero();
    for (std::size_t i = begin; i < end; ++i) {
      const double g = nr * samples[i].r + nw * samples[i].w, x = (g - mean) / scale_;
      weight[i - begin] = samples[i].area / ((1 + x * x) * (1 + x * x));
      sum += weight[i - begin];
      g_mean += weight[i - begin] * g;
      j_mean += weight[i - begin] * change(samples[i], nr, nw);
    }
    if (!(sum > 0)) return;
    g_mean /= sum;
    j_mean /= sum;
    for (std::size_t i = begin; i < end; ++i) {
      const double g = nr * samples[i].r + nw * samples[i].w - g_mean;
      const Vec5 j = change(samples[i], nr, nw) - j_mean;
      A_ += weight[i - begin] * j * j.transpose();
      b_ -= weight[i - begin] * j * g;
      square_ += weight[i - begin] * g * g;
      weight_ += weight[i - begin];
    }
  }

  static double middle(const std::vector<Sample>& samples, std::size_t begin, std::size_t end, double nr, double nw) {
    std::vector<double> g;
    for (std::size_t i = begin; i < end; ++i) g.push_back(nr * samples[i].r + nw * samples[i].w);
    std::nth_element(g.begin(), g.begin() + static_cast<std::ptrdiff_t>(g.size() / 2), g.end());
    return g[g.size() / 2];
  }

  /// By how much the corner moves along the profile's normal when the axis goes by (1, 0) and (0, 1), leans by them,
  /// and rises by 1 more.
  Vec5 change(const Sample& s, double nr, double nw) const {
    const double h = rise_ / s.r;
    Vec5 j;
    j << -nr * s.cos - nw * h * s.sin, -nr * s.sin + nw * h * s.cos,
        -s.z * nr * s.cos + nw * (s.r * s.cos - h * s.z * s.sin),
        -s.z * nr * s.sin + nw * (s.r * s.sin + h * s.z * s.cos), rise_ == 0 ? 0 : -nw * s.phi;
    return j;
  }

  double rise_, scale_;
  Mat5 A_ = Mat5::Zero();
  Vec5 b_ = Vec5::Zero();
  double square_ = 0, weight_ = 0;
};

/// How well the corners of a long thread lie on top of each other with one rise: the largest of some harmonics of
/// their places along the axis, over a turn (a thread of n starts has the n-th).
double coherence(const std::vector<Sample>& samples, double rise) {
  std::map<int, std::array<std::complex<double>, kHarmonics>> sums;
  double area = 0;
  for (const Sample& s : samples) {
    const double place = (s.z + s.nr / s.nw * s.r) / rise - s.phi;
    const std::complex<double> one = std::polar(1.0, place);
    std::complex<double> power = s.area;
    for (auto& sum : sums[std::get<2>(s.cell)]) sum += power *= one;
    area += s.area;
  }
  std::array<double, kHarmonics> of{};
  for (const auto& [turn, sum] : sums)
    for (std::size_t n = 0; n < kHarmonics; ++n) of[n] += std::abs(sum[n]);
  return area > 0 ? *std::max_element(of.begin(), of.end()) / area : 0;
}

/// The rise near `motion`'s that lays all turns of a thread onto one another. A few percent off, and the ends of a long
/// thread are turns apart: no step from there leads to it.
ScrewMotion laid(const std::vector<Facet>& facets, const std::vector<std::size_t>& of, ScrewMotion motion) {
  const Frame f(motion);
  std::vector<Sample> samples;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Sample& s : samples_of(facets, of, f))
    if (s.nw > kLeaning) samples.push_back(s), low = std::min(low, s.z), high = std::max(high, s.z);
  if (f.rise == 0 || samples.empty()) return motion;
  const double turns = (high - low) / (2 * kPi * std::abs(f.rise));
  const std::size_t stride = samples.size() / kMaxLaid + 1;
  std::vector<Sample> some;
  for (std::size_t i = 0; i < samples.size(); i += stride) some.push_back(samples[i]);
  const int steps = static_cast<int>(std::ceil(kWindow * kStepsPerTurn * turns));
  double rise = f.rise, most = kBetter * coherence(some, rise);
  for (int i = -steps; i <= steps; ++i) {
    const double other = f.rise * (1 + kWindow * i / std::max(steps, 1)), here = coherence(some, other);
    if (here > most) most = here, rise = other;
  }
  motion.c_bar += (rise - f.rise) * motion.c;
  return motion;
}

}  // namespace

ScrewMotion refined(const std::vector<Facet>& facets, const std::vector<std::size_t>& of, const ScrewMotion& motion) {
  ScrewMotion best = laid(facets, of, motion);
  double scale = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kRefineRounds; ++round) {
    const Frame f(best);
    const Equations equations(samples_of(facets, of, f), f.rise, scale);
    scale = std::max(2 * equations.rms(), 1e-9);
    const Vec5 x = equations.solve();
    if (!x.allFinite() || x.norm() > kMaxChange) return best;
    ScrewMotion next;
    next.c = (f.c + x[2] * f.e1 + x[3] * f.e2).normalized();
    const Vec3 p = f.p + x[0] * f.e1 + x[1] * f.e2;
    next.c_bar = -next.c.cross(p) + (f.rise == 0 ? 0.0 : f.rise + x[4]) * next.c;
    if (f.rise == 0) next.c_bar -= next.c * next.c.dot(next.c_bar);
    best = next;
  }
  return best;
}

}  // namespace tegotae
