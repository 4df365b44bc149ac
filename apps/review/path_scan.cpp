#include "review/path_scan.hpp"

#include <algorithm>
#include <cmath>

#include "broadphase/bounding_spheres.hpp"
#include "core/parallel_for.hpp"
#include "loop/mesh_structures.hpp"
#include "loop/scene_parts.hpp"
#include "session/fit_watch.hpp"
#include "view/follower.hpp"

namespace tegotae::review {
namespace {

constexpr std::size_t kMaxRows = 20000;
// Share of the held part's radius: the scan measures the distance of every part nearer than this, not of the nearest
// alone.
constexpr double kReachShare = 0.2;
constexpr double kTwoSided = 0.1736;  // sine of 10 degrees
constexpr int kMaxSteps = 500;

constexpr std::size_t kBlock = 128;  // rows in a row that one thread measures

/// What a contact loop says at a row when it is led along the poses.
struct LedRow {
  double contact_gap = 0;             // m
  std::vector<Vec3> normals, places;  // of its contacts, W, m
};

/// Sets what the contacts of a row are: those of the led loop, which knows many places of one part but only of parts
/// that are in its way, and the nearest place of every part.
void add_contacts(const LedRow& led, ScannedRow& out) {
  out.contact_gap = led.contact_gap;
  std::vector<Vec3> normals;
  Vec3 sum = Vec3::Zero();
  const auto add = [&](const Vec3& normal, const Vec3& place) {
    normals.push_back(normal);
    sum += place;
  };
  for (const Clearance& c : out.clearances)
    if (c.distance > 0 && c.distance <= out.contact_gap) add((c.on_held_W - c.on_other_W) / c.distance, c.on_held_W);
  for (std::size_t i = 0; i < led.normals.size(); ++i) add(led.normals[i], led.places[i]);
  out.two_sided = holds_from_two_sides(normals);
  if (out.two_sided) out.contact_W = sum / static_cast<double>(normals.size());
}

LedRow led_row(const view::Follower& follower) {
  const HapticLoop& loop = follower.loop();
  LedRow out;
  out.contact_gap = loop.report().contact_gap;
  const Vec3 center = loop.report().proxy.X * loop.center();
  for (const Contact& c : loop.constraints()) {
    if (follower.astray() || c.age == kOneShotAge || c.gap > out.contact_gap) continue;
    out.normals.push_back(c.n);
    out.places.push_back(center + c.r);
  }
  return out;
}

/// Leads a contact loop along all rows, which takes them one after the other.
std::vector<LedRow> lead(view::Follower& follower, const Scene& scene, const std::vector<RecordFrame>& rows,
                         const std::vector<ScannedRow>& scanned, HeldFast& held_fast) {
  FitWatch watch(follower.loop(), scene);
  std::vector<LedRow> out;
  out.reserve(scanned.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    follower.step(rows[i]);
    if (follower.loop().report().shrunk > 0)
      watch.update(follower.loop(), rows[i].y, i > 0 ? rows[i].t - rows[i - 1].t : 0, held_fast);
    if (scanned[out.size()].row == i) out.push_back(led_row(follower));
  }
  return out;
}

/// Measures the clearances of a block of rows; what it finds depends on nothing else.
void measure(const Scene& scene, const std::vector<RecordFrame>& rows, double reach, std::size_t begin, std::size_t end,
             std::vector<ScannedRow>& scanned) {
  ClearanceProbe probe(scene);
  for (std::size_t i = begin; i < end; ++i) {
    const Pose& X = rows[scanned[i].row].x;
    const bool still =
        i > begin && X.p == rows[scanned[i - 1].row].x.p && X.q.coeffs() == rows[scanned[i - 1].row].x.q.coeffs();
    if (still)
      scanned[i].clearances = scanned[i - 1].clearances;
    else
      probe.at(X, reach, scanned[i].clearances);
  }
}

}  // namespace

std::vector<std::size_t> looked_at(std::size_t rows, std::size_t most) {
  std::vector<std::size_t> out;
  const std::size_t every = (rows + most - 1) / most;
  for (std::size_t i = 0; i < rows; i += every) out.push_back(i);
  if (rows > 0 && out.back() != rows - 1) out.push_back(rows - 1);
  return out;
}

bool holds_from_two_sides(const std::vector<Vec3>& normals) {
  if (normals.empty()) return false;
  // Gilbert's way to the point of the hull that is nearest to the origin.
  Vec3 x = normals.front();
  for (int step = 0; step < kMaxSteps; ++step) {
    const double length = x.norm();
    if (length <= kTwoSided) return true;
    const Vec3& n = *std::min_element(normals.begin(), normals.end(),
                                      [&](const Vec3& a, const Vec3& b) { return a.dot(x) < b.dot(x); });
    if (n.dot(x) > kTwoSided * length) return false;
    x += std::clamp(x.dot(x - n) / (x - n).squaredNorm(), 0.0, 1.0) * (n - x);
  }
  return false;
}

Scan scan_path(const Scene& scene, const std::string& file, const std::vector<RecordFrame>& rows,
               const Progress& progress, double reach) {
  Scan scan;
  scan.reach = std::max(reach, kReachShare * bounding_sphere(*held_part(scene).mesh).radius);
  const std::vector<std::size_t> numbers = looked_at(rows.size(), kMaxRows);
  scan.every = numbers.size() > 1 ? numbers[1] - numbers[0] : 1;
  const MeshStructures made(scene.parts, scene.contact.narrowphase, [&](std::size_t done, std::size_t total) {
    if (progress) progress("building hierarchies", done, total);
  });
  view::Follower follower(scene, file, rows.front().x);
  scan.center = follower.loop().center();
  scan.coupling = follower.loop().coupling();
  scan.start = follower.loop().start();
  for (const std::size_t i : numbers) {
    scan.rows.emplace_back();
    scan.rows.back().row = i;
  }
  std::vector<LedRow> led;
  // One thread leads the loop, the others measure, and then all do.
  const auto job = [&](int k) {
    if (k == 0) {
      led = lead(follower, scene, rows, scan.rows, scan.held_fast);
      return;
    }
    const std::size_t begin = static_cast<std::size_t>(k - 1) * kBlock;
    measure(scene, rows, scan.reach, begin, std::min(begin + kBlock, numbers.size()), scan.rows);
  };
  const auto blocks = static_cast<int>((numbers.size() + kBlock - 1) / kBlock);
  parallel_for(blocks + 1, 0, job, [&](int done) {
    if (progress) progress("measuring clearances, row", static_cast<std::size_t>(done - 1) * kBlock, numbers.size());
  });
  for (std::size_t i = 0; i < led.size(); ++i) add_contacts(led[i], scan.rows[i]);
  scan.astray = follower.strayed();
  return scan;
}

}  // namespace tegotae::review
