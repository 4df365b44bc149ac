#pragma once

#include <cstdint>
#include <vector>

#include "mesh/topology.hpp"

namespace tegotae {

/// The flat regions of a surface that have more than one face: faces that are connected by flat edges and lie within
/// kFlatAngle of one plane. Where such a region rests on something, its extreme corners hold it, however far they are
/// from the face that touched first.
struct FlatRegions {
  std::vector<std::uint32_t> of_face;       ///< F: number of its region; kNone for a face that is a region of its own
  std::vector<std::uint32_t> corner_begin;  ///< regions + 1: offsets into `corners`
  std::vector<std::uint32_t>
      corners;  ///< extreme vertices of each region in order around it, at most kMaxRegionCorners
};

/// A region with more corners on its convex hull (a disk) keeps the extreme ones of as many directions.
inline constexpr std::size_t kMaxRegionCorners = 16;

/// The flat regions of `mesh`, whose adjacency is `topology`. Linear but for sorting the rim of each region.
FlatRegions find_flat_regions(const TriangleMesh& mesh, const Topology& topology);

}  // namespace tegotae
