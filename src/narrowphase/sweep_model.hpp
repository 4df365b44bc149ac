#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "narrowphase/backing.hpp"
#include "narrowphase/block_slabs.hpp"
#include "narrowphase/cell_front.hpp"
#include "narrowphase/face_blocks.hpp"
#include "narrowphase/face_lanes.hpp"
#include "narrowphase/facing.hpp"
#include "narrowphase/normal_cone.hpp"
#include "narrowphase/patch_tree.hpp"

namespace tegotae {

/// What looks at all faces of A (see SurfaceSweep) know of it and of the fixed parts. It never changes, and any number
/// of threads may read it.
struct SweepModel {
  /// Larger surfaces are not looked at as a whole: blocks take about 1 µs a triangle at every start.
  static constexpr std::size_t kMostFaces = 1U << 21;

  /// The faces of a tree.
  struct Surface {
    explicit Surface(const PatchTree& tree);

    FaceBlocks blocks;
    BlockSlabs slabs;
    std::vector<FaceLanes> lanes;  ///< of each block
  };
  struct Part {
    std::shared_ptr<const PatchTree> tree;
    std::shared_ptr<const Surface> surface;  ///< null: too large
    Pose pose;
  };
  /// Which way A's faces look, and the nodes of the levels that have slabs.
  struct Cones {
    const std::vector<NormalCone>* faces = nullptr;
    std::vector<std::vector<NormalCone>> nodes;
  };

  /// As the constructor of SurfaceSweep.
  SweepModel(std::shared_ptr<const PatchTree> a, const Vec3& center, const std::vector<CellFront::FixedPart>& fixed,
             std::shared_ptr<const Facing> facing, std::shared_ptr<const Backing> backing);

  std::shared_ptr<const PatchTree> a;
  std::shared_ptr<const Facing> facing;
  std::shared_ptr<const Backing> backing;
  std::shared_ptr<const Surface> surface_of_a;
  std::array<std::shared_ptr<const Surface>, 2> walls;  ///< on each side of the backing; null: none
  Cones facing_cones, backing_cones;                    ///< if there are those
  Vec3 center;                                          ///< A's center of mass, m, file frame
  double reach;                                         ///< of A about it, m
  std::vector<Part> parts;

 private:
  Cones cones_of(const std::vector<NormalCone>& faces) const;
};

}  // namespace tegotae
