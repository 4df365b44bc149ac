#pragma once

#include <XSControl_WorkSession.hxx>
#include <string>
#include <vector>

namespace tegotae {

struct CheckedEntities {
  std::vector<bool> of_shape;  ///< see of_shape()
  /// Whether colors can be read: OpenCASCADE follows null pointers in damaged ones.
  bool has_colors = true;
  /// Items of shapes that are of unknown kinds, each "#17 is a ...". OpenCASCADE sees them no more.
  std::vector<std::string> unread;
  /// Units and places that OpenCASCADE would have read otherwise than they are meant, each "#17 is a ...".
  std::vector<std::string> changed;
};

/// Looks through the entities that OpenCASCADE has read, before they become shapes, and tells units and places as it
/// reads them right. Throws Error when one that shapes or places are made of is damaged, or places a part in a way that
/// OpenCASCADE drops.
CheckedEntities check_entities(const std::string& path, const Handle(XSControl_WorkSession) & session);

/// The files of parts that the file `path` names and that are not there. Throws Error when one is not in the file's
/// folder or below.
std::vector<std::string> named_files(const std::string& path, const Handle(XSControl_WorkSession) & session);

/// Solids of representations, and shells and surfaces that are items by themselves of shapes (`reached` as from
/// of_shape()), of which OpenCASCADE has made nothing, each "#17 is a BLOCK".
std::vector<std::string> unread_solids(const Handle(XSControl_WorkSession) & session, const std::vector<bool>& reached);

/// Representations that several products have for their shape, of which OpenCASCADE makes one, each
/// "\"left\", \"right\" of #17, which is read ...".
std::vector<std::string> shared_shapes(const Handle(XSControl_WorkSession) & session);

/// Instances of products that no entity places, each "#17".
std::vector<std::string> unplaced(const Handle(XSControl_WorkSession) & session);

}  // namespace tegotae
