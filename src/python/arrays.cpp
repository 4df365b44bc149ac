#include "python/arrays.hpp"

#include <nanobind/stl/string.h>

#include <cmath>

#include "core/valid_pose.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::python {
namespace {

/// How far R Rᵀ may be from the identity: products of a few rotations in double precision, or one of single precision.
constexpr double kRotationTolerance = 1e-5;

using Block = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;

std::string text(const std::vector<std::ptrdiff_t>& shape) {
  std::string s = "(";
  for (const std::ptrdiff_t n : shape) s += (s.size() > 1 ? ", " : "") + (n < 0 ? "n" : std::to_string(n));
  return s + (shape.size() == 1 ? ",)" : ")");
}

/// NumPy makes numbers of text and of dates too, and drops what complex numbers have beside their real part.
void require_real(nb::handle array, const char* name) {
  const auto kind = nb::cast<std::string>(array.attr("dtype").attr("kind"));
  if (kind.find_first_not_of("biufO") == std::string::npos) return;
  const auto type = nb::cast<std::string>(array.attr("dtype").attr("name"));
  throw nb::type_error((std::string(name) + ": real numbers are wanted, not " + type).c_str());
}

}  // namespace

Numbers numbers(nb::handle value, std::initializer_list<std::ptrdiff_t> shape, const char* name) {
  const nb::module_ numpy = nb::module_::import_("numpy");
  const nb::object given_array = numpy.attr("asarray")(value);
  require_real(given_array, name);
  nb::object array = numpy.attr("ascontiguousarray")(given_array, nb::arg("dtype") = "float64");
  const auto block = nb::cast<Block>(array);
  const std::vector<std::ptrdiff_t> wanted(shape);
  std::vector<std::ptrdiff_t> given;
  for (std::size_t i = 0; i < block.ndim(); ++i) given.push_back(static_cast<std::ptrdiff_t>(block.shape(i)));
  bool fits = given.size() == wanted.size();
  for (std::size_t i = 0; fits && i < wanted.size(); ++i) fits = wanted[i] < 0 || wanted[i] == given[i];
  if (!fits)
    throw Error(ErrorKind::setting, std::string(name) + ": the shape is " + text(given) + ", not " + text(wanted));
  return {std::move(array), block.data(), static_cast<std::size_t>(given.front())};
}

Pose pose_of(const double* rows, const std::string& name) {
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> X(rows);
  const Mat3 R = X.topLeftCorner<3, 3>();
  const auto fail = [&name](const char* why) { throw Error(ErrorKind::setting, name + ": " + why); };
  if (!X.allFinite()) fail("a number of the pose is not finite");
  if (!within_reach(X.topRightCorner<3, 1>())) fail("the position lies beyond 10 km; positions are in m");
  if (X.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) fail("the last row of a pose is 0, 0, 0, 1");
  if (!((R * R.transpose()).isIdentity(kRotationTolerance) && R.determinant() > 0))
    fail("the upper left 3 x 3 of a pose is a rotation: no scale, no shear, no mirror");
  return {Quat(R).normalized(), X.topRightCorner<3, 1>()};
}

Pose pose_of(nb::handle value, const char* name) {
  if (value.is_none()) return {};
  return pose_of(numbers(value, {4, 4}, name).data, name);
}

Vec3 vector_of(nb::handle value, const char* name) {
  return Vec3::Map(numbers(value, {3}, name).data);
}

void write_rows(const Pose& pose, double* rows) noexcept {
  Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> X(rows);
  X.setIdentity();
  X.topLeftCorner<3, 3>() = pose.q.toRotationMatrix();
  X.topRightCorner<3, 1>() = pose.p;
}

PoseArray to_array(const Pose& pose) {
  std::vector<double> rows(16);
  write_rows(pose, rows.data());
  return owned<PoseArray>(std::move(rows), {4, 4});
}

WrenchArray to_array(const Wrench& w) {
  return owned<WrenchArray>(
      std::vector<double>{w.force.x(), w.force.y(), w.force.z(), w.torque.x(), w.torque.y(), w.torque.z()}, {6});
}

PointArray to_array(const Vec3& point) {
  return owned<PointArray>(std::vector<double>{point.x(), point.y(), point.z()}, {3});
}

nb::object row_type(const std::vector<Field>& fields, std::size_t size) {
  nb::list names, formats, offsets;
  for (const Field& f : fields) {
    names.append(f.name);
    formats.append(f.format);
    offsets.append(f.offset);
  }
  nb::dict type;
  type["names"] = names;
  type["formats"] = formats;
  type["offsets"] = offsets;
  type["itemsize"] = size;
  return nb::module_::import_("numpy").attr("dtype")(type);
}

}  // namespace tegotae::python
