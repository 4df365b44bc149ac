#pragma once

#include <vector>

#include "feature/signed_distance.hpp"

namespace tegotae {

/// A vertex of one surface near the other one.
struct ShellPoint {
  double gap;  ///< of the vertex to the other surface, negative inside, m
  Vec3
      p_A;  ///< the point of the moving surface A that meets: the vertex, or the nearest point to it, A's file frame, m
  Vec3 n_A;            ///< unit, the way A leaves, A's axes
  Feature on_a, on_b;  ///< a vertex of one surface and a face of the other
};

/// Which vertices of two surfaces are near or inside the other: those of A against B and those of B against A. A vertex
/// is not looked at again before A may have come near enough.
class VertexShell {
 public:
  VertexShell(std::shared_ptr<const SignedDistance> A, std::shared_ptr<const SignedDistance> B);

  /// A has moved since the last call by a motion that carries none of its points farther than `moved` (m).
  void move(double moved) noexcept { traveled_ += moved; }
  /// Appends every vertex with a gap below `reach` (m) when A is at `X_BA`, as far as the capacity of `out` goes;
  /// returns false when that was used up.
  bool collect(const Pose& X_BA, double reach, std::vector<ShellPoint>& out) noexcept;

 private:
  struct Vertex {
    Vec3 p;               ///< its own file frame
    std::uint32_t index;  ///< in its mesh
    std::uint32_t face = 0;
    double clear = 0;  ///< gap when it was looked at, plus what A had traveled by then
  };
  static std::vector<Vertex> vertices(const Surface& s);

  std::shared_ptr<const SignedDistance> A_, B_;
  std::vector<Vertex> of_a_, of_b_;
  double traveled_ = 0;
};

}  // namespace tegotae
