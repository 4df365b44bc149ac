#pragma once

#include <cstdint>
#include <vector>

#include "review/path_scan.hpp"

namespace tegotae::review {

/// The held part as it is shown, with the least clearance of its points over a path.
struct ColoredSurface {
  std::vector<float> positions;        ///< x, y, z of points of the part's surface, file frame, m
  std::vector<std::uint32_t> indices;  ///< three a triangle
  std::vector<float> clearance;        ///< of each point, m; at most `reach`, which stands for anything more
  double reach = 0;                    ///< m
};

/// Points spread over the surface of `mesh`, its own vertices among them unless there are too many; about `most`
/// triangles.
ColoredSurface sampled_surface(const std::shared_ptr<const TriangleMesh>& mesh, std::size_t most);

/// Sets the clearance of every point: the least distance to a triangle of another part over the rows `looked_at` of the
/// recording. Works on all processors; the result does not depend on their number.
void add_clearance(const Scene& scene, const std::vector<RecordFrame>& rows, const std::vector<std::size_t>& looked_at,
                   double reach, const Progress& progress, ColoredSurface& surface);

}  // namespace tegotae::review
