#pragma once

#include <nanobind/nanobind.h>

namespace tegotae::python {

// Each adds its classes and functions to the module, those that others use first.
void bind_meshes(nanobind::module_& m);
void bind_scenes(nanobind::module_& m);
void bind_pens(nanobind::module_& m);
void bind_rig(nanobind::module_& m);
void bind_runs(nanobind::module_& m);
void bind_reviews(nanobind::module_& m);
void bind_plans(nanobind::module_& m);

}  // namespace tegotae::python
