#pragma once

#include <TDF_Label.hxx>
#include <map>
#include <string>

#include "import/occt_triangles.hpp"

namespace tegotae {

/// What a product holds, itself or in its components.
struct Content {
  bool faces = false;  ///< or triangles
  bool lines = false;  ///< curves or points that bound no face
  bool taken = false;  ///< tessellated shapes, read or not
};

/// What the products of a document hold, looked up once each.
class ProductContents {
 public:
  /// `triangles` outlives this.
  explicit ProductContents(const TransferredTriangles& triangles) : triangles_(triangles) {}

  Content of(const TDF_Label& product);

 private:
  Content inspect(const TDF_Label& product);
  bool has_lines(const TopoDS_Shape& shape) const;

  const TransferredTriangles& triangles_;
  std::map<std::string, Content> known_;
};

/// The place of a label in its document, "0:1:1:2".
std::string entry_of(const TDF_Label& label);

}  // namespace tegotae
