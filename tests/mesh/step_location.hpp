// Places of OpenCASCADE's shapes.
#pragma once

#include <TopLoc_Location.hxx>
#include <gp_Trsf.hxx>
#include <gp_Vec.hxx>

namespace tegotae::test {

/// A shift, in the unit of the document.
inline TopLoc_Location at(double x, double y, double z) {
  gp_Trsf t;
  t.SetTranslation(gp_Vec(x, y, z));
  return t;
}

}  // namespace tegotae::test
