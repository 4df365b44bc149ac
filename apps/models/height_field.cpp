#include "models/height_field.hpp"

#include <cmath>
#include <vector>

#include "core/numbers.hpp"
#include "models/mesh_builder.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::shapes {
namespace {

/// Corners of the grid, row by row along y for each x.
class Corners {
 public:
  Corners(const Grid& grid, const Height& z, MeshBuilder& b) : nx_(grid.cells_x), ny_(grid.cells_y) {
    if (!(grid.size_x > 0 && grid.size_y > 0 && nx_ > 0 && ny_ > 0)) throw Error("a grid needs a size and cells");
    for (int i = 0; i <= nx_; ++i) {
      for (int k = 0; k <= ny_; ++k) {
        const double x = grid.size_x * (static_cast<double>(i) / nx_ - 0.5);
        const double y = grid.size_y * (static_cast<double>(k) / ny_ - 0.5);
        index_.push_back(b.vertex({x, y, z(x, y)}));
      }
    }
  }
  std::uint32_t at(int i, int k) const { return index_[static_cast<std::size_t>(i) * (ny_ + 1) + k]; }

  void faces(MeshBuilder& b, bool up) const {
    for (int i = 0; i < nx_; ++i) {
      for (int k = 0; k < ny_; ++k) {
        const std::uint32_t a = at(i, k), c = at(i + 1, k + 1);
        const std::uint32_t right = at(i + 1, k), left = at(i, k + 1);
        b.face(a, up ? right : c, up ? c : right);
        b.face(a, up ? c : left, up ? left : c);
      }
    }
  }
  /// The corners on the rim, counter-clockwise from above.
  Ring rim() const {
    Ring out;
    for (int i = 0; i < nx_; ++i) out.push_back(at(i, 0));
    for (int k = 0; k < ny_; ++k) out.push_back(at(nx_, k));
    for (int i = nx_; i > 0; --i) out.push_back(at(i, ny_));
    for (int k = ny_; k > 0; --k) out.push_back(at(0, k));
    return out;
  }

 private:
  int nx_, ny_;
  std::vector<std::uint32_t> index_;
};

}  // namespace

TriangleMesh sheet(const Grid& grid, const Height& z) {
  MeshBuilder b("sheet");
  Corners(grid, z, b).faces(b, true);
  return b.take();
}

TriangleMesh slab(const Grid& grid, const Height& lower, const Height& upper) {
  MeshBuilder b("slab");
  const Corners below(grid, lower, b), above(grid, upper, b);
  below.faces(b, false);
  above.faces(b, true);
  b.band(below.rim(), above.rim());
  return b.take();
}

Height waves(double amplitude, double wave) {
  return [=](double x, double y) { return amplitude * std::sin(2 * kPi * x / wave) * std::sin(2 * kPi * y / wave); };
}

}  // namespace tegotae::shapes
