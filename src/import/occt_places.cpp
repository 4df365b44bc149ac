#include "import/occt_places.hpp"

#include <StepGeom_Axis2Placement3d.hxx>
#include <StepGeom_CartesianTransformationOperator3d.hxx>
#include <StepGeom_Direction.hxx>
#include <StepRepr_ItemDefinedTransformation.hxx>
#include <StepRepr_MappedItem.hxx>
#include <StepRepr_RepresentationMap.hxx>
#include <StepRepr_RepresentationRelationshipWithTransformation.hxx>
#include <StepRepr_Transformation.hxx>
#include <StepShape_ContextDependentShapeRepresentation.hxx>
#include <cmath>
#include <gp_Vec.hxx>

#include "import/occt_entities.hpp"
#include "import/occt_frames.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

using Entity = Handle(Standard_Transient);
using Frame = StepGeom_Axis2Placement3d;
using Operator = StepGeom_CartesianTransformationOperator3d;

/// The direction as a unit vector; `fallback` without one. A zero vector stands for none that can be.
gp_Vec vector_of(const Handle(StepGeom_Direction) & direction, const gp_Vec& fallback) {
  if (direction.IsNull() || direction->NbDirectionRatios() < 3) return fallback;
  const gp_Vec v(direction->DirectionRatiosValue(1), direction->DirectionRatiosValue(2),
                 direction->DirectionRatiosValue(3));
  return v.Magnitude() > 0 ? v.Normalized() : gp_Vec();
}

/// `v` without its share along the unit vectors `x` and `y`, as a unit vector; zero when nothing is left.
gp_Vec beside(const gp_Vec& v, const gp_Vec& x, const gp_Vec& y) {
  const gp_Vec rest = v - x * v.Dot(x) - y * v.Dot(y);
  return rest.Magnitude() > 1e-9 ? rest.Normalized() : gp_Vec();
}

/// What an operator does besides turning and shifting, or does to axes that it leaves out; empty when OpenCASCADE reads
/// it as ISO 10303-42 (base_axis) means it. OpenCASCADE makes every frame right-handed.
std::string not_rigid(const Operator& map) {
  if (map.HasScale() && std::abs(map.Scale() - 1) > 1e-9) return "scales";
  const gp_Vec ex(1, 0, 0), ey(0, 1, 0), ez(0, 0, 1);
  const gp_Vec z = vector_of(map.Axis3(), ez);
  const gp_Vec x = beside(vector_of(map.Axis1(), std::abs(z.X()) < 1 ? ex : ey), z, gp_Vec());
  const gp_Vec y = beside(vector_of(map.Axis2(), ey), z, x);
  if (z.Magnitude() == 0 || x.Magnitude() == 0 || y.Magnitude() == 0) return "has axes that span no space for";
  if (x.Crossed(y).Dot(z) < 0) return "mirrors";
  const gp_Vec first = vector_of(map.Axis1(), ex);
  const gp_Vec read_z = map.HasAxis3() ? z : first.Crossed(vector_of(map.Axis2(), ey));
  if (read_z.Magnitude() < 1e-9 || (read_z.Normalized() - z).Magnitude() > 1e-9 ||
      (beside(first, z, gp_Vec()) - x).Magnitude() > 1e-9)
    return "leaves out axes that place";
  return "";
}

/// Whether a frame is the one of the coordinates in it.
bool is_identity(const Frame& frame) {
  const auto X = frame_of(frame);
  return X && (*X - Matrix34::Identity()).cwiseAbs().maxCoeff() < 1e-9;
}

class Places {
 public:
  Places(const std::string& path, const Handle(StepData_StepModel) & model) : path_(path), model_(model) {}

  void require(const Entity& entity) const {
    const auto item = Handle(StepRepr_MappedItem)::DownCast(entity);
    if (!item.IsNull()) require_mapped(*item);
    const auto relation = Handle(StepRepr_RepresentationRelationshipWithTransformation)::DownCast(entity);
    if (!relation.IsNull()) require_related(relation->TransformationOperator().Value());
    const auto shown = Handle(StepShape_ContextDependentShapeRepresentation)::DownCast(entity);
    if (!shown.IsNull() &&
        !shown->RepresentationRelation()->IsKind(STANDARD_TYPE(StepRepr_RepresentationRelationshipWithTransformation)))
      throw Error(path_ + ": " + named(model_, entity) +
                  " whose relationship has no transformation: its part would be read twice, in one place");
  }

 private:
  std::string number(const Entity& entity) const { return "#" + std::to_string(model_->IdentLabel(entity)); }

  void require_mapped(const StepRepr_MappedItem& item) const {
    const Entity target = item.MappingTarget(), origin = item.MappingSource()->MappingOrigin();
    if (target->IsKind(STANDARD_TYPE(Operator)))
      require_rigid(Handle(Operator)::DownCast(target));
    else
      require_frame(target);
    require_frame(origin);
    if (target->IsKind(STANDARD_TYPE(Operator)) && !is_identity(*Handle(Frame)::DownCast(origin)))
      throw Error(path_ + ": the operator " + number(target) + " places a part whose frame " + number(origin) +
                  " is not its origin, which is not read: export such parts as shapes of their own");
  }

  void require_related(const Entity& transformation) const {
    const auto items = Handle(StepRepr_ItemDefinedTransformation)::DownCast(transformation);
    if (!items.IsNull()) {
      require_frame(items->TransformItem1());
      require_frame(items->TransformItem2());
    } else if (transformation->IsKind(STANDARD_TYPE(Operator))) {
      require_rigid(Handle(Operator)::DownCast(transformation));
    } else {
      require_frame(transformation);
    }
  }

  void require_rigid(const Handle(Operator) & map) const {
    const std::string fault = not_rigid(*map);
    if (!fault.empty())
      throw Error(path_ + ": the CARTESIAN_TRANSFORMATION_OPERATOR_3D " + number(map) + " " + fault +
                  " a part, which is not read: export such parts as shapes of their own");
  }

  void require_frame(const Entity& entity) const {
    if (!entity->IsKind(STANDARD_TYPE(Frame)))
      throw Error(path_ + ": " + named(model_, entity) +
                  ", and a part is placed by it, which is not read: export such parts as shapes of their own");
  }

  const std::string& path_;
  const Handle(StepData_StepModel) & model_;
};

}  // namespace

void require_places(const std::string& path, const Handle(StepData_StepModel) & model,
                    const std::vector<bool>& reached) {
  const Places places(path, model);
  for (int i = 1; i <= model->NbEntities(); ++i)
    if (reached[static_cast<std::size_t>(i)]) places.require(model->Value(i));
}

}  // namespace tegotae
