// The extension module: errors, and everything that the other files bind.
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include "python/bindings.hpp"
#include "python/running.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/core/version.hpp"

namespace tegotae::python {
namespace {

namespace nb = nanobind;

const char* word(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::file:
      return "file";
    case ErrorKind::setting:
      return "setting";
    case ErrorKind::overlap:
      return "overlap";
    case ErrorKind::device:
      return "device";
    case ErrorKind::other:
      break;
  }
  return "other";
}

/// Makes tegotae.Error of an Error.
void translate(const std::exception_ptr& thrown, void*) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Error& e) {
    const ErrorPlace place = e.place();
    const nb::object type = nb::module_::import_("tegotae._error").attr("Error");
    const nb::object error = type(e.what(), word(e.kind()), place.file, place.line, place.key, place.part);
    PyErr_SetObject(type.ptr(), error.ptr());
  }
}

}  // namespace
}  // namespace tegotae::python

NB_MODULE(_tegotae, m) {
  using namespace tegotae::python;
  m.doc() = "The compiled part of tegotae. Use the package tegotae, which exports what is public.";
  m.attr("version") = TEGOTAE_VERSION_STRING;
  nanobind::register_exception_translator(translate);
  bind_meshes(m);
  bind_scenes(m);
  bind_pens(m);
  bind_rig(m);
  bind_runs(m);
  bind_reviews(m);
  bind_plans(m);
  // Threads of rigs that still run would ask for an interpreter that is gone.
  nanobind::module_::import_("atexit").attr("register")(nanobind::cpp_function(&stop_all_running));
}
