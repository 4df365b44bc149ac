#include "import/occt_content.hpp"

#include <TDF_LabelSequence.hxx>
#include <TDF_Tool.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Iterator.hxx>
#include <XCAFDoc_ShapeTool.hxx>

namespace tegotae {

std::string entry_of(const TDF_Label& label) {
  TCollection_AsciiString entry;
  TDF_Tool::Entry(label, entry);
  return entry.ToCString();
}

Content ProductContents::of(const TDF_Label& product) {
  const std::string entry = entry_of(product);
  const auto known = known_.find(entry);
  return known != known_.end() ? known->second : known_[entry] = inspect(product);
}

Content ProductContents::inspect(const TDF_Label& product) {
  if (!XCAFDoc_ShapeTool::IsAssembly(product)) {
    const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(product);
    if (shape.IsNull()) return {};
    return {TopExp_Explorer(shape, TopAbs_FACE).More() || triangles_.are_in(shape), has_lines(shape),
            triangles_.any_in(shape)};
  }
  Content all;
  TDF_LabelSequence components;
  XCAFDoc_ShapeTool::GetComponents(product, components);
  for (const TDF_Label& component : components) {
    TDF_Label part;
    if (!XCAFDoc_ShapeTool::GetReferredShape(component, part)) continue;
    const Content one = of(part);
    all = {all.faces || one.faces, all.lines || one.lines, all.taken || one.taken};
  }
  return all;
}

bool ProductContents::has_lines(const TopoDS_Shape& shape) const {
  if (shape.ShapeType() > TopAbs_FACE && shape.ShapeType() < TopAbs_SHAPE) return true;
  if (shape.ShapeType() != TopAbs_COMPOUND || triangles_.stands_for_some(shape)) return false;
  for (TopoDS_Iterator i(shape); i.More(); i.Next())
    if (has_lines(i.Value())) return true;
  return false;
}

}  // namespace tegotae
