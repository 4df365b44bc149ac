#include "models/bricks.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "models/mesh_builder.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/mesh/weld.hpp"

namespace tegotae::shapes {
namespace {

constexpr double kSamePlane = 1e-9;  // m

/// The cells between the planes of all bricks.
class Cells {
 public:
  explicit Cells(const std::vector<Brick>& bricks) {
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double>& planes = planes_[axis];
      for (const Brick& b : bricks) {
        if (!(b.low[axis] < b.high[axis])) throw Error("a brick needs a size in all directions");
        planes.insert(planes.end(), {b.low[axis], b.high[axis]});
      }
      std::sort(planes.begin(), planes.end());
      planes.erase(std::unique(planes.begin(), planes.end(), [](double a, double b) { return b - a < kSamePlane; }),
                   planes.end());
    }
    filled_.assign(static_cast<std::size_t>(cells(0)) * cells(1) * cells(2), 0);
    for (int i = 0; i < cells(0); ++i)
      for (int j = 0; j < cells(1); ++j)
        for (int k = 0; k < cells(2); ++k)
          for (const Brick& b : bricks)
            if (covers(b, {i, j, k})) filled_[index({i, j, k})] = b.solid ? 1 : 0;
  }

  int cells(int axis) const { return static_cast<int>(planes_[axis].size()) - 1; }
  bool filled(const std::array<int, 3>& c) const {
    for (int axis = 0; axis < 3; ++axis)
      if (c[axis] < 0 || c[axis] >= cells(axis)) return false;
    return filled_[index(c)] != 0;
  }
  Vec3 corner(const std::array<int, 3>& c) const { return {planes_[0][c[0]], planes_[1][c[1]], planes_[2][c[2]]}; }

 private:
  std::size_t index(const std::array<int, 3>& c) const {
    return (static_cast<std::size_t>(c[0]) * cells(1) + c[1]) * cells(2) + c[2];
  }
  bool covers(const Brick& b, const std::array<int, 3>& c) const {
    for (int axis = 0; axis < 3; ++axis) {
      const double middle = 0.5 * (planes_[axis][c[axis]] + planes_[axis][c[axis] + 1]);
      if (middle < b.low[axis] || middle > b.high[axis]) return false;
    }
    return true;
  }

  std::array<std::vector<double>, 3> planes_;
  std::vector<char> filled_;
};

/// The face of cell `c` on one of its sides across `axis`, looking outward.
void add_face(const Cells& cells, const std::array<int, 3>& c, int axis, bool upper, MeshBuilder& b) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  std::array<std::uint32_t, 4> q;
  const int step[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (int i = 0; i < 4; ++i) {
    std::array<int, 3> at = c;
    at[axis] += upper ? 1 : 0;
    at[u] += step[i][0];
    at[v] += step[i][1];
    q[i] = b.vertex(cells.corner(at));
  }
  if (!upper) std::swap(q[1], q[3]);
  b.face(q[0], q[1], q[2]);
  b.face(q[0], q[2], q[3]);
}

}  // namespace

TriangleMesh solid_of(const std::string& name, const std::vector<Brick>& bricks) {
  const Cells cells(bricks);
  MeshBuilder b(name);
  for (int i = 0; i < cells.cells(0); ++i)
    for (int j = 0; j < cells.cells(1); ++j)
      for (int k = 0; k < cells.cells(2); ++k) {
        const std::array<int, 3> c = {i, j, k};
        if (!cells.filled(c)) continue;
        for (int axis = 0; axis < 3; ++axis)
          for (const int side : {-1, 1}) {
            std::array<int, 3> next = c;
            next[axis] += side;
            if (!cells.filled(next)) add_face(cells, c, axis, side > 0, b);
          }
      }
  TriangleMesh mesh = b.take();
  if (mesh.triangles.empty()) throw Error("nothing is left of the bricks");
  return weld(mesh);
}

}  // namespace tegotae::shapes
