#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "import/round_faces.hpp"

namespace tegotae {
namespace {

// Faces of one cylinder (a hole drawn in two halves) agree to this, m and rad.
constexpr double kSameCylinder = 1e-8;
// Moving corners along a slanted plane widens the angle of their facets a little: repeated until nothing reaches in.
constexpr int kRounds = 6;
// A corner between surfaces that are nearly tangent would slide far: past this many times the radial way it leaves the
// plane instead.
constexpr double kLongestSlide = 4;

/// The faces of one cylinder.
struct Cylinder {
  CadFace cad;
  std::vector<std::size_t> faces;
  double target = 0;  ///< m: where the corners belong
};

/// From the axis to `p`, square to it.
Vec3 radial(const CadFace& c, const Vec3& p) {
  const Vec3 d = p - c.point;
  return d - c.axis * c.axis.dot(d);
}

std::vector<Cylinder> cylinders_of(const std::vector<CadFace>& faces) {
  std::vector<Cylinder> all;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (faces[f].kind != FaceKind::cylinder) continue;
    const auto same = [&](const Cylinder& c) {
      return c.cad.hole == faces[f].hole && std::abs(c.cad.radius - faces[f].radius) < kSameCylinder &&
             c.cad.axis.cross(faces[f].axis).norm() < kSameCylinder &&
             radial(c.cad, faces[f].point).norm() < kSameCylinder;
    };
    auto found = std::find_if(all.begin(), all.end(), same);
    if (found == all.end()) found = all.insert(all.end(), {faces[f], {}, 0});
    found->faces.push_back(f);
  }
  return all;
}

/// Distance of the segment a b from the origin, for vectors square to the axis.
double segment_distance(const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double s = d.squaredNorm() > 0 ? std::clamp(-a.dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
  return (a + s * d).norm();
}

class Mover {
 public:
  Mover(TessellatedShape& shape, const std::vector<CadFace>& faces, double margin)
      : mesh_(shape.mesh), faces_(faces), margin_(margin), cylinders_(cylinders_of(faces)) {
    triangles_of_.resize(faces.size());
    faces_at_.resize(mesh_.vertices.size());
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      const std::uint32_t f = shape.face_of[t];
      triangles_of_[f].push_back(t);
      for (const std::uint32_t v : mesh_.triangles[t]) {
        if (std::find(faces_at_[v].begin(), faces_at_[v].end(), f) == faces_at_[v].end()) faces_at_[v].push_back(f);
      }
    }
    cylinder_of_.assign(faces.size(), kNo);
    for (std::size_t c = 0; c < cylinders_.size(); ++c) {
      for (const std::size_t f : cylinders_[c].faces) cylinder_of_[f] = c;
    }
  }

  ClearanceReport run() {
    const std::vector<Vec3> before = mesh_.vertices;
    for (Cylinder& c : cylinders_)
      c.target = c.cad.hole ? (c.cad.radius + margin_) / std::cos(widest_half_angle(c)) : c.cad.radius - margin_;
    for (int round = 0; round < kRounds; ++round) {
      for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v) move(v);
      bool done = true;
      for (Cylinder& c : cylinders_) {
        const double short_by = c.cad.hole ? c.cad.radius + margin_ - nearest(c) : 0;
        if (short_by <= 0) continue;
        c.target += 1.01 * short_by + 1e-15;
        done = false;
      }
      if (done) break;
    }
    return measure(before);
  }

 private:
  static constexpr std::size_t kNo = std::numeric_limits<std::size_t>::max();

  /// Half of the widest angle that an edge of a facet spans, seen from the axis.
  double widest_half_angle(const Cylinder& c) const {
    double widest = 0;
    for_edges(
        c, [&](const Vec3& a, const Vec3& b) { widest = std::max(widest, std::atan2(a.cross(b).norm(), a.dot(b))); });
    return std::min(0.5 * widest, 1.5);
  }

  /// Distance of the nearest facet from the axis.
  double nearest(const Cylinder& c) const {
    double least = std::numeric_limits<double>::infinity();
    for_edges(c, [&](const Vec3& a, const Vec3& b) { least = std::min(least, segment_distance(a, b)); });
    return least;
  }

  double farthest(const Cylinder& c) const {
    double most = 0;
    for_edges(c, [&](const Vec3& a, const Vec3&) { most = std::max(most, a.norm()); });
    return most;
  }

  template <typename F>
  void for_edges(const Cylinder& c, F f) const {
    for (const std::size_t face : c.faces) {
      for (const std::uint32_t t : triangles_of_[face]) {
        for (int k = 0; k < 3; ++k) {
          const auto& corners = mesh_.triangles[t];
          f(radial(c.cad, mesh_.vertices[corners[k]]), radial(c.cad, mesh_.vertices[corners[(k + 1) % 3]]));
        }
      }
    }
  }

  /// The least move of vertex `v` that puts it where its cylinders want it and, if that can be, keeps it in its planes.
  void move(std::uint32_t v) {
    std::vector<std::pair<Vec3, double>> rows;  // direction, how far along it
    double longest = 0;
    for (const std::uint32_t f : faces_at_[v]) {
      if (cylinder_of_[f] == kNo) continue;
      const Cylinder& c = cylinders_[cylinder_of_[f]];
      const Vec3 r = radial(c.cad, mesh_.vertices[v]);
      const double way = c.target - r.norm();
      const double wanted = c.cad.hole ? std::max(way, 0.0) : std::min(way, 0.0);
      rows.emplace_back(r.normalized(), wanted);
      longest = std::max(longest, std::abs(wanted));
    }
    if (longest == 0) return;
    const std::size_t of_cylinders = rows.size();
    for (const std::uint32_t f : faces_at_[v]) {
      if (faces_[f].kind == FaceKind::plane) rows.emplace_back(faces_[f].axis, 0.0);
    }
    const Vec3 d = least_move(rows);
    bool met = d.norm() <= kLongestSlide * longest;
    for (std::size_t i = 0; i < of_cylinders; ++i)
      met = met && std::abs(rows[i].first.dot(d) - rows[i].second) <= 1e-6 * longest;
    if (met) {
      mesh_.vertices[v] += d;
      return;
    }
    rows.resize(of_cylinders);
    mesh_.vertices[v] += least_move(rows);
  }

  static Vec3 least_move(const std::vector<std::pair<Vec3, double>>& rows) {
    Eigen::Matrix<double, Eigen::Dynamic, 3> A(rows.size(), 3);
    Eigen::VectorXd b(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      A.row(static_cast<Eigen::Index>(i)) = rows[i].first.transpose();
      b[static_cast<Eigen::Index>(i)] = rows[i].second;
    }
    Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix<double, Eigen::Dynamic, 3>> solver;
    solver.setThreshold(1e-7);
    return solver.compute(A).solve(b);
  }

  ClearanceReport measure(const std::vector<Vec3>& before) const {
    ClearanceReport report;
    for (const Cylinder& c : cylinders_) {
      const double in = c.cad.hole ? c.cad.radius - nearest(c) : farthest(c) - c.cad.radius;
      report.into_clearance = std::max(report.into_clearance, in);
    }
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (faces_[f].kind != FaceKind::plane) continue;
      for (const std::uint32_t t : triangles_of_[f]) {
        const auto& v = mesh_.triangles[t];
        for (const std::uint32_t i : v)
          report.bent = std::max(report.bent, std::abs(faces_[f].axis.dot(mesh_.vertices[i] - before[i])));
        const Vec3 was = (before[v[1]] - before[v[0]]).cross(before[v[2]] - before[v[0]]);
        const Vec3 is =
            (mesh_.vertices[v[1]] - mesh_.vertices[v[0]]).cross(mesh_.vertices[v[2]] - mesh_.vertices[v[0]]);
        report.turned += was.dot(is) < 0;
      }
    }
    return report;
  }

  TriangleMesh& mesh_;
  const std::vector<CadFace>& faces_;
  const double margin_;
  std::vector<Cylinder> cylinders_;
  std::vector<std::size_t> cylinder_of_;  ///< of each face, kNo of what is not a cylinder
  std::vector<std::vector<std::uint32_t>> triangles_of_;
  std::vector<std::vector<std::uint32_t>> faces_at_;  ///< of each vertex
};

}  // namespace

ClearanceReport keep_clearance(TessellatedShape& shape, const std::vector<CadFace>& faces, double margin) {
  return Mover(shape, faces, margin).run();
}

}  // namespace tegotae
