#pragma once

#include <TopoDS_Shape.hxx>
#include <TopoDS_TShape.hxx>
#include <XSControl_WorkSession.hxx>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "import/step_triangles.hpp"

namespace tegotae {

/// The tessellated shapes of a STEP file, found again in what OpenCASCADE made of the points that stand for them.
class TransferredTriangles {
 public:
  TransferredTriangles() = default;
  /// After the transfer. Shapes that are shown exactly too are dropped.
  TransferredTriangles(std::vector<StepTriangles> shapes, const Handle(XSControl_WorkSession) & session);

  /// All triangles in `shape`, its frame, m, welded; no triangles: it has none.
  TriangleMesh in(const TopoDS_Shape& shape);
  /// Of the same, m^2.
  double area_in(const TopoDS_Shape& shape);
  /// Whether there are triangles in `shape`.
  bool are_in(const TopoDS_Shape& shape) const;
  /// Whether a tessellated shape belongs to `shape`, read or not.
  bool any_in(const TopoDS_Shape& shape) const;
  /// Whether `shape` is points in the place of a tessellated shape.
  bool stands_for_some(const TopoDS_Shape& shape) const { return shapes_.count(shape.TShape().get()) > 0; }
  /// The entities with triangles that were in no shape.
  std::vector<std::uint64_t> unused() const;

 private:
  void collect(const TopoDS_Shape& shape, TriangleMesh& to);

  std::map<const TopoDS_TShape*, StepTriangles> shapes_;
  std::set<std::uint64_t> unused_;
};

}  // namespace tegotae
