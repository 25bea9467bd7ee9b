// SPDX-License-Identifier: MIT
/// Shared declarations of the Python module `catena._catena`. Every function that takes long releases the interpreter's lock; an error is
/// raised as catena.Error with the one-line message that the program would print. Returned arrays own their memory.
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

/// Exception raised in Python as catena.Error, or as catena.MachineError if the machine lacks a resource (memory, a Vulkan device).
struct Failure : std::runtime_error {
  explicit Failure(const Error& error) : std::runtime_error(error.message), message(error.message), machine(error.system_failure) {}
  std::string message;  ///< Full message; what() ends at a zero byte
  bool machine;         ///< True: raised as catena.MachineError
};

/// Returns the value of a Result; throws Failure for an Error.
template <class T>
T unwrap(Result<T> result) {
  if (!result) throw Failure(result.error());
  return std::move(*result);
}

/// A field as a Python object.
struct Field {
  field::AnyField any;
};

/// Returns a path (str, bytes or os.PathLike) in the encoding of the file system.
std::string to_path(const py::object& path);

/// C-contiguous array of doubles.
using NumberArray = py::array_t<double, py::array::c_style | py::array::forcecast>;
/// Converts an array of any shape to doubles. Throws Failure, with `what` as the array's name, if it does not hold real numbers.
NumberArray to_numbers(const py::object& array, const std::string& what);
/// Returns the shape as NumPy prints it: "(2, 3)".
std::string format_shape(const py::array& array);
/// Array of points: shape (N, 3), or (3,) for one point. The converters throw Failure for another shape; `what` names the array in
/// messages.
using Points = py::object;
/// Converts to doubles; C-contiguous doubles are not copied.
NumberArray to_rows(const Points& array, const std::string& what);
std::vector<Vec3> to_points(const Points& array, const std::string& what);
/// Returns an array of shape (N, 3).
py::array_t<double> to_array(const std::vector<Vec3>& points);
/// Converts exactly one point; several throw Failure.
Vec3 to_vec3(const Points& array, const std::string& what);

/// Converts a Field, or anything that catena.field() accepts: an array, masked or not, or a path.
Field to_field(const py::handle& value, const std::string& name);

/// Returns the scene of a path (scene file or data file), of a dict with the contents of a scene file, of a Field or of an array. `fields`:
/// dict of names and fields (anything to_field accepts) that the scene uses, or None.
scene::Scene to_scene(const py::object& what, const py::object& fields);

/// Each adds the functions and classes of one source file to the module.
void add_fields(py::module_& m);
void add_arrays(py::module_& m);
void add_curves(py::module_& m);
void add_chain(py::module_& m);
void add_images(py::module_& m);
void add_measurements(py::module_& m);
void add_tables(py::module_& m);

}  // namespace catena::python
