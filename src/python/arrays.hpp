#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tegotae/core/pose.hpp"

namespace tegotae::python {

namespace nb = nanobind;

using PoseArray = nb::ndarray<nb::numpy, double, nb::shape<4, 4>>;
using WrenchArray = nb::ndarray<nb::numpy, double, nb::shape<6>>;
using PointArray = nb::ndarray<nb::numpy, double, nb::shape<3>>;

/// Numbers that somebody gave as an array or a list, in one block in the order of C.
struct Numbers {
  nb::object array;      ///< owns them
  const double* data;    ///< the first one
  std::size_t rows = 0;  ///< length of the first axis
};

/// `value` as numbers of this shape (-1: any length). Throws Error that calls it `name` when it has another one,
/// TypeError when it is complex or text.
Numbers numbers(nb::handle value, std::initializer_list<std::ptrdiff_t> shape, const char* name);

/// A rigid pose of 16 numbers in the order of rows. Throws Error that calls it `name` when it is none.
Pose pose_of(const double* rows, const std::string& name);
/// The same of a (4, 4) array; None is the identity.
Pose pose_of(nb::handle value, const char* name);
/// Three numbers.
Vec3 vector_of(nb::handle value, const char* name);

/// The 16 numbers of `pose` in the order of rows.
void write_rows(const Pose& pose, double* rows) noexcept;

PoseArray to_array(const Pose& pose);
WrenchArray to_array(const Wrench& wrench);
PointArray to_array(const Vec3& point);

/// An array that owns `values`.
template <class Array, class T>
Array owned(std::vector<T> values, std::initializer_list<std::size_t> shape) {
  auto* kept = new std::vector<T>(std::move(values));
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  return Array(kept->data(), shape, owner);
}

/// A column of a table.
template <class T>
nb::object column(std::vector<T> values) {
  const std::size_t n = values.size();
  return nb::cast(owned<nb::ndarray<nb::numpy, T, nb::ndim<1>>>(std::move(values), {n}));
}

/// A field of a structured array: name, numpy's format, offset in the row.
struct Field {
  const char* name;
  const char* format;
  std::size_t offset;
};

/// numpy.dtype of rows of `size` bytes.
nb::object row_type(const std::vector<Field>& fields, std::size_t size);
/// A structured array that owns `rows`, whose dtype is `type`.
template <class Row>
nb::object row_array(nb::handle type, std::vector<Row> rows) {
  auto* kept = new std::vector<Row>(std::move(rows));
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<Row>*>(p); });
  const std::size_t size = kept->size() * sizeof(Row);
  nb::ndarray<nb::numpy, std::uint8_t, nb::ndim<1>> bytes(kept->data(), {size}, owner);
  return nb::cast(bytes).attr("view")(type);
}

}  // namespace tegotae::python
