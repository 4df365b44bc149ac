#include "review/path_scan.hpp"

#include <algorithm>
#include <cmath>

#include "broadphase/bounding_spheres.hpp"
#include "loop/scene_parts.hpp"
#include "view/follower.hpp"

namespace tegotae::review {
namespace {

constexpr std::size_t kMaxRows = 20000;
// Of the held part's radius: nearer parts have their distances told, whichever is nearest.
constexpr double kReachShare = 0.2;
constexpr double kTwoSided = 0.1736;  // sine of 10 degrees
constexpr int kMaxSteps = 500;
constexpr std::size_t kTellEvery = 64;  // rows

/// Contacts at a row whose clearances are known: those of the led loop, which knows many places of one part but only of
/// parts that are in its way, and the nearest place of every part.
void add_contacts(const view::Follower& follower, ScannedRow& out) {
  const HapticLoop& loop = follower.loop();
  out.contact_gap = loop.report().contact_gap;
  std::vector<Vec3> normals;
  Vec3 sum = Vec3::Zero();
  const auto add = [&](const Vec3& normal, const Vec3& place) {
    normals.push_back(normal);
    sum += place;
  };
  for (const Clearance& c : out.clearances)
    if (c.distance > 0 && c.distance <= out.contact_gap) add((c.on_held_W - c.on_other_W) / c.distance, c.on_held_W);
  const Vec3 center = loop.report().proxy.X * loop.center();
  for (const Contact& c : loop.constraints())
    if (!follower.astray() && c.age != kOneShotAge && c.gap <= out.contact_gap) add(c.n, center + c.r);
  out.two_sided = holds_from_two_sides(normals);
  if (out.two_sided) out.contact_W = sum / static_cast<double>(normals.size());
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
               const Progress& progress) {
  Scan scan;
  scan.reach = kReachShare * bounding_sphere(*held_part(scene).mesh).radius;
  const std::vector<std::size_t> numbers = looked_at(rows.size(), kMaxRows);
  scan.every = numbers.size() > 1 ? numbers[1] - numbers[0] : 1;
  ClearanceProbe probe(scene);
  view::Follower follower(scene, file, rows.front().x);
  scan.center = follower.loop().center();
  scan.coupling = follower.loop().coupling();
  scan.start = follower.loop().start();
  scan.rows.reserve(numbers.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (progress && i % kTellEvery == 0) progress("measuring clearances, row", i, rows.size());
    follower.step(rows[i]);
    if (numbers[next] != i) continue;
    ++next;
    ScannedRow row;
    row.row = i;
    const bool still = i > 0 && rows[i].x.p == rows[i - 1].x.p && rows[i].x.q.coeffs() == rows[i - 1].x.q.coeffs();
    if (still && scan.every == 1)
      row.clearances = scan.rows.back().clearances;
    else
      probe.at(rows[i].x, scan.reach, row.clearances);
    add_contacts(follower, row);
    scan.rows.push_back(std::move(row));
  }
  scan.astray = follower.strayed();
  return scan;
}

}  // namespace tegotae::review
