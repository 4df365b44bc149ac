#include "import/occt_frames.hpp"

#include <StepGeom_CartesianPoint.hxx>
#include <StepGeom_Direction.hxx>
#include <StepRepr_ItemDefinedTransformation.hxx>
#include <StepRepr_MappedItem.hxx>
#include <StepRepr_Representation.hxx>
#include <StepRepr_RepresentationMap.hxx>
#include <StepRepr_RepresentationRelationshipWithTransformation.hxx>
#include <StepRepr_Transformation.hxx>
#include <TColStd_HArray1OfReal.hxx>
#include <TCollection_HAsciiString.hxx>
#include <algorithm>
#include <gp_Ax2.hxx>
#include <utility>

#include "import/occt_units.hpp"

namespace tegotae {
namespace {

using PlacedFrame = StepGeom_Axis2Placement3d;

// Frames that differ by less are the same.
constexpr double kSameFrame = 1e-9;

/// The direction as a unit vector; `fallback` without one, and zero when it is none that can be.
Vec3 unit_of(const Handle(StepGeom_Direction) & direction, const Vec3& fallback) {
  if (direction.IsNull() || direction->DirectionRatios().IsNull() || direction->NbDirectionRatios() < 3)
    return fallback;
  const Vec3 v(direction->DirectionRatiosValue(1), direction->DirectionRatiosValue(2),
               direction->DirectionRatiosValue(3));
  return v.norm() > 0 ? Vec3(v.normalized()) : Vec3(Vec3::Zero());
}

/// `v` without its share along the unit vector `z`, as a unit vector; zero when nothing is left.
Vec3 across(const Vec3& v, const Vec3& z) {
  const Vec3 rest = v - z * z.dot(v);
  return rest.norm() > kSameFrame ? Vec3(rest.normalized()) : Vec3(Vec3::Zero());
}

bool is_unmoved(const Matrix34& X) {
  return (X - Matrix34::Identity()).cwiseAbs().maxCoeff() < kSameFrame;
}

/// Whether OpenCASCADE, which chooses the second axis by itself where there is none, gives the frame that is meant.
bool is_read_as_meant(const PlacedFrame& frame, const Matrix34& meant) {
  if (across(unit_of(frame.RefDirection(), Vec3::Zero()), meant.col(2)).norm() > 0) return true;
  const gp_Dir x = gp_Ax2(gp_Pnt(), gp_Dir(meant(0, 2), meant(1, 2), meant(2, 2))).XDirection();
  return (Vec3(x.X(), x.Y(), x.Z()) - meant.col(0)).norm() < kSameFrame;
}

Handle(StepGeom_Direction) new_direction(const Vec3& v) {
  const Handle(TColStd_HArray1OfReal) ratios = new TColStd_HArray1OfReal(1, 3);
  for (int k = 0; k < 3; ++k) ratios->SetValue(k + 1, v[k]);
  Handle(StepGeom_Direction) out = new StepGeom_Direction;
  out->Init(new TCollection_HAsciiString(""), ratios);
  return out;
}

Handle(PlacedFrame) new_frame(const Matrix34& X) {
  const Handle(StepGeom_CartesianPoint) at = new StepGeom_CartesianPoint;
  at->Init3D(new TCollection_HAsciiString(""), X(0, 3), X(1, 3), X(2, 3));
  Handle(PlacedFrame) out = new PlacedFrame;
  out->Init(new TCollection_HAsciiString(""), at, true, new_direction(X.col(2)), true, new_direction(X.col(0)));
  return out;
}

bool has_item(const Handle(StepRepr_Representation) & shape, const Handle(Standard_Transient) & item) {
  if (shape.IsNull() || shape->Items().IsNull()) return false;
  for (int i = 1; i <= shape->NbItems(); ++i)
    if (shape->ItemsValue(i) == item) return true;
  return false;
}

/// How many units of `to` one of `from` is.
double units_ratio(const Handle(StepRepr_Representation) & from, const Handle(StepRepr_Representation) & to) {
  if (from.IsNull() || to.IsNull()) return 1;
  const auto a = unit_of_length(*from), b = unit_of_length(*to);
  return a && b ? *a / *b : 1;
}

/// Where what lies in the frame `from` comes to lie when `from` comes to lie on `to`, whose unit is so many times
/// smaller than that of `from`; none when OpenCASCADE finds that as well.
std::optional<Matrix34> place_by(const PlacedFrame& from, const PlacedFrame& to, double ratio) {
  const auto a = frame_of(from), b = frame_of(to);
  if (!a || !b) return std::nullopt;
  const bool one_moves = is_unmoved(*a) || is_unmoved(*b);
  if (one_moves && is_read_as_meant(from, *a) && is_read_as_meant(to, *b)) return std::nullopt;
  Matrix34 X;
  X.leftCols<3>() = b->leftCols<3>() * a->leftCols<3>().transpose();
  X.col(3) = b->col(3) - ratio * (X.leftCols<3>() * a->col(3));
  return X;
}

bool make_plain(const Handle(StepRepr_RepresentationRelationshipWithTransformation) & relation) {
  const auto items = Handle(StepRepr_ItemDefinedTransformation)::DownCast(relation->TransformationOperator().Value());
  if (items.IsNull()) return false;
  auto from = Handle(PlacedFrame)::DownCast(items->TransformItem1());
  auto to = Handle(PlacedFrame)::DownCast(items->TransformItem2());
  if (from.IsNull() || to.IsNull()) return false;
  const Handle(StepRepr_Representation) part = relation->Rep1(), whole = relation->Rep2();
  // Some programs exchange the two, which OpenCASCADE notices by where they are.
  if ((!has_item(part, from) || !has_item(whole, to)) && has_item(part, to) && has_item(whole, from))
    std::swap(from, to);
  const auto place = place_by(*from, *to, units_ratio(part, whole));
  if (!place) return false;
  // Others may have these items too.
  const Handle(StepRepr_ItemDefinedTransformation) own = new StepRepr_ItemDefinedTransformation;
  own->Init(items->Name(), items->Description(), new_frame(Matrix34::Identity()), new_frame(*place));
  StepRepr_Transformation moved;
  moved.SetValue(own);
  relation->SetTransformationOperator(moved);
  return true;
}

bool make_plain(const Handle(StepRepr_MappedItem) & item, const Handle(StepRepr_Representation) & whole) {
  const Handle(StepRepr_RepresentationMap) source = item->MappingSource();
  const auto from = Handle(PlacedFrame)::DownCast(source->MappingOrigin());
  const auto to = Handle(PlacedFrame)::DownCast(item->MappingTarget());
  if (from.IsNull() || to.IsNull()) return false;
  const Handle(StepRepr_Representation) part = source->MappedRepresentation();
  const auto place = place_by(*from, *to, units_ratio(part, whole));
  if (!place) return false;
  const Handle(StepRepr_RepresentationMap) own = new StepRepr_RepresentationMap;
  own->Init(new_frame(Matrix34::Identity()), part);
  item->SetMappingSource(own);
  item->SetMappingTarget(new_frame(*place));
  return true;
}

}  // namespace

std::optional<Matrix34> frame_of(const StepGeom_Axis2Placement3d& frame) {
  const Handle(StepGeom_CartesianPoint) at = frame.Location();
  if (at.IsNull() || at->Coordinates().IsNull()) return std::nullopt;
  const Vec3 z = unit_of(frame.Axis(), Vec3::UnitZ());
  if (z.norm() == 0) return std::nullopt;
  Vec3 x = across(unit_of(frame.RefDirection(), Vec3::Zero()), z);
  for (const Vec3& instead : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY())})
    if (x.norm() == 0) x = across(instead, z);
  Matrix34 X;
  X << x, z.cross(x), z, Vec3::Zero();
  for (int k = 0; k < std::min(3, at->NbCoordinates()); ++k) X(k, 3) = at->CoordinatesValue(k + 1);
  return X;
}

std::vector<Handle(Standard_Transient)> plain_places(const Handle(StepData_StepModel) & model,
                                                     const std::vector<bool>& reached) {
  std::vector<Handle(Standard_Transient)> changed;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    if (!reached[static_cast<std::size_t>(i)]) continue;
    const Handle(Standard_Transient) entity = model->Value(i);
    const auto relation = Handle(StepRepr_RepresentationRelationshipWithTransformation)::DownCast(entity);
    if (!relation.IsNull() && make_plain(relation)) changed.push_back(entity);
    const auto whole = Handle(StepRepr_Representation)::DownCast(entity);
    if (whole.IsNull() || whole->Items().IsNull()) continue;
    for (int k = 1; k <= whole->NbItems(); ++k) {
      const auto item = Handle(StepRepr_MappedItem)::DownCast(whole->ItemsValue(k));
      if (!item.IsNull() && make_plain(item, whole)) changed.push_back(item);
    }
  }
  return changed;
}

}  // namespace tegotae
