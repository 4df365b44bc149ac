#pragma once

#include <optional>
#include <vector>

#include "broadphase/bounding_boxes.hpp"
#include "tegotae/loop/scene.hpp"

namespace tegotae {

/// A box along the world's axes, m.
struct WorldBox {
  Vec3 low, high;
};

/// When the held part is out of the others: its box lies beside the box around all of them.
class Exit {
 public:
  /// `center` of mass of the held part (file frame, m), `radius` of it about that.
  Exit(const Scene& scene, const Vec3& center, double radius);

  /// By how much (m) a part of that radius is to be out: a twentieth of it.
  static double margin(double radius);
  /// Whether the held part is out at `X`, by the margin.
  bool is_out(const Pose& X) const;
  /// Whether it is beside the box around the others there, by whatever little.
  bool is_beside(const Pose& X) const { return is_beside(X, 0); }
  /// Poses at which it is out, with the orientation of `from`: straight out along the axes of the world and of the
  /// part.
  std::vector<Pose> straight_out(const Pose& from) const;
  /// The room in which a way out is looked for: center of mass of the held part, world.
  const WorldBox& room() const { return room_; }

 private:
  bool is_beside(const Pose& X, double margin) const;

  Vec3 center_;
  double margin_;
  Box box_;          ///< of the held part
  WorldBox others_;  ///< around all other parts
  WorldBox room_;
};

}  // namespace tegotae
