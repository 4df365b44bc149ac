#pragma once

#include <TopoDS_Face.hxx>
#include <TopoDS_TShape.hxx>
#include <XSControl_WorkSession.hxx>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "import/round_faces.hpp"

namespace tegotae {

/// Indices of the faces with an edge that no other face shares: where a shape is not closed. Ascending.
std::vector<std::size_t> faces_with_free_edges(const TessellatedShape& shape);

/// Says which face of a STEP file is meant.
class FaceNames {
 public:
  explicit FaceNames(Handle(XSControl_WorkSession) session) : session_(std::move(session)) {}

  /// The first of `which` and how many more there are: "face #123 (a cylinder around (1, 2, 3) mm) and 2 more". Without
  /// the number where OpenCASCADE has mended the face.
  std::string text(const std::vector<std::size_t>& which, const std::vector<TopoDS_Face>& faces,
                   const std::vector<CadFace>& known);

 private:
  void find_numbers();

  Handle(XSControl_WorkSession) session_;
  std::map<const TopoDS_TShape*, int> number_;  // of each face that was transferred; empty before it is needed
};

}  // namespace tegotae
