#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "narrowphase/patch_tree.hpp"

namespace tegotae {

/// Faces of a surface by where they are seen along an axis, in a grid across it: which of them a line along the axis
/// may pass is known without a search. About 45 bytes a face, up to 150. Immutable.
class FaceColumns {
 public:
  FaceColumns() = default;
  /// Of those `faces`; `axis` is of unit length.
  FaceColumns(const PatchTree& tree, const Vec3& axis, const std::vector<std::uint32_t>& faces);

  /// A face, and from where to where it is along the axis, from the tree's origin, m, or a little more.
  struct Face {
    float low, high;
    std::uint32_t face;
  };
  struct Faces {
    const Face *first, *last;
    const Face* begin() const { return first; }
    const Face* end() const { return last; }
  };
  /// Whether some face may reach between two places along the axis (m, from the tree's origin).
  bool reach(double low, double high) const noexcept { return all_.high >= low && all_.low <= high; }
  /// All faces, and maybe more, that the line through `p` (m, from the tree's origin) along the axis passes.
  Faces beside(const Vec3& p) const noexcept;

 private:
  typedef std::array<double, 2> Place;  ///< across the axis, m

  Place place_of(const Vec3& p) const { return {p.dot(across_[0]), p.dot(across_[1])}; }
  /// Of the cell, along one of the grid's axes; those outside are in the first or the last.
  std::uint32_t cell_of(double at, std::size_t i) const;

  std::array<Vec3, 2> across_{Vec3::UnitX(), Vec3::UnitY()};
  Place low_{}, high_{};
  std::array<double, 2> size_{1, 1};        ///< of a cell, m
  std::array<std::uint32_t, 2> cells_{{}};  ///< along each of the grid's axes
  std::vector<std::uint32_t> first_;        ///< of each cell, in faces_; the end after the last
  std::vector<Face> faces_;
  struct {
    float low = std::numeric_limits<float>::infinity(), high = -std::numeric_limits<float>::infinity();
  } all_;  ///< of all faces
};

}  // namespace tegotae
