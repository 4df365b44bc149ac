#include "models/write_obj.hpp"

#include <cmath>
#include <cstdio>

#include "core/output_file.hpp"

namespace tegotae {
namespace {

/// Millimeters, with the rounding noise around zero taken away (else cos(90°) reads 6e-17).
double millimeters(double meters) {
  constexpr double kNoise = 1e-12;  // mm; far under the ninth digit of any part's size
  const double mm = 1000 * meters;
  return std::abs(mm) < kNoise ? 0.0 : mm;
}

}  // namespace

void write_obj(const TriangleMesh& mesh, const std::string& path) {
  std::string text = "# " + mesh.name + ", mm\n";
  char line[128];
  for (const Vec3& p : mesh.vertices) {
    std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", millimeters(p.x()), millimeters(p.y()), millimeters(p.z()));
    text += line;
  }
  for (const auto& t : mesh.triangles) {
    std::snprintf(line, sizeof line, "f %u %u %u\n", t[0] + 1, t[1] + 1, t[2] + 1);
    text += line;
  }
  write_file(path, text);
}

}  // namespace tegotae
