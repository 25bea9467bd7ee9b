/// The Python module `catena._catena`: what its files share. Every function that takes long releases the interpreter's lock; an error is
/// raised as catena.Error with the one line that the program would print. Arrays that come back own their memory.
#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/result.h"
#include "engine/field/field.h"
#include "engine/scene/scene.h"

namespace catena::python {

namespace py = pybind11;

/// Becomes catena.Error, or catena.MachineError where the machine does not give what is needed.
struct Failure : std::runtime_error {
  explicit Failure(const Error& error) : std::runtime_error(error.message), message(error.message), machine(error.system_failure) {}
  std::string message;  ///< what() ends at a zero byte
  bool machine;
};

template <class T>
T unwrap(Result<T> result) {
  if (!result) throw Failure(result.error());
  return std::move(*result);
}

/// A field as Python holds it.
struct Field {
  field::AnyField any;
};

/// A path (str, bytes or os.PathLike) in the bytes of the file system.
std::string to_path(const py::object& path);

/// Real numbers of whatever shape; what holds none is an error that names `what`.
using NumberArray = py::array_t<double, py::array::c_style | py::array::forcecast>;
NumberArray to_numbers(const py::object& array, const std::string& what);
/// As NumPy writes it: "(2, 3)".
std::string format_shape(const py::array& array);
/// N x 3 of them, or three; another shape is an error. to_rows: without a copy where they are doubles in a row.
using Points = py::object;
NumberArray to_rows(const Points& array, const std::string& what);
std::vector<Vec3> to_points(const Points& array, const std::string& what);
py::array_t<double> to_array(const std::vector<Vec3>& points);
Vec3 to_vec3(const Points& array, const std::string& what);

/// A Field, or what catena.field() makes one of: an array, masked or not, or a path.
Field to_field(const py::handle& value, const std::string& name);

/// A scene of a path (a scene file or a data file), a dict as the scene file's object, a Field or an array. `fields`: names and what
/// field_of() takes, which the scene uses, or None.
scene::Scene to_scene(const py::object& what, const py::object& fields);

void add_fields(py::module_& m);
void add_arrays(py::module_& m);
void add_curves(py::module_& m);
void add_chain(py::module_& m);
void add_images(py::module_& m);
void add_tables(py::module_& m);

}  // namespace catena::python
