#include "models/write_obj.hpp"

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "tegotae/core/error.hpp"

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
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) throw Error(path + ": cannot be written: " + std::strerror(errno));
  std::fprintf(file, "# %s, mm\n", mesh.name.c_str());
  for (const Vec3& p : mesh.vertices) {
    std::fprintf(file, "v %.9g %.9g %.9g\n", millimeters(p.x()), millimeters(p.y()), millimeters(p.z()));
  }
  for (const auto& t : mesh.triangles) std::fprintf(file, "f %u %u %u\n", t[0] + 1, t[1] + 1, t[2] + 1);
  const bool written = std::ferror(file) == 0;
  if (std::fclose(file) != 0 || !written) throw Error(path + ": cannot be written: " + std::strerror(errno));
}

}  // namespace tegotae
