#include "models/write_stl.hpp"

#include <cstdint>

#include "core/output_file.hpp"

namespace tegotae {

void write_stl(const TriangleMesh& mesh, const std::string& path) {
  std::string bytes(80, ' ');
  const auto put = [&bytes](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) put(0.0f);
    for (const std::uint32_t v : t)
      for (const double x : mesh.vertices[v]) put(static_cast<float>(1e3 * x));
    put(std::uint16_t{0});
  }
  write_file(path, bytes);
}

}  // namespace tegotae
