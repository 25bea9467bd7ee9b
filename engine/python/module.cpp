// SPDX-License-Identifier: MIT
#include "engine/python/module.h"

#include <algorithm>
#include <string_view>

#include "engine/base/version.h"
#include "engine/scene/scene.h"
#include "engine/scene/scene_from_object.h"

namespace catena::python {

std::string to_path(const py::object& path) { return py::cast<std::string>(py::module_::import("os").attr("fsencode")(path)); }

NumberArray to_numbers(const py::object& array, const std::string& what) {
  const py::array any = py::array::ensure(array);
  if (any && std::string_view("biuf").find(any.dtype().kind()) != std::string_view::npos)
    if (NumberArray numbers = NumberArray::ensure(any)) return numbers;
  PyErr_Clear();
  throw Failure(
      Error{what + (any ? ": holds " + py::cast<std::string>(py::str(any.dtype())) : ": is no array") + "; real numbers were expected"});
}

std::string format_shape(const py::array& array) { return py::cast<std::string>(py::str(array.attr("shape"))); }

NumberArray to_rows(const Points& points, const std::string& what) {
  NumberArray array = to_numbers(points, what);
  const bool one = array.ndim() == 1 && array.shape(0) == 3;
  if (!one && !(array.ndim() == 2 && array.shape(1) == 3))
    throw Failure(Error{what + " has the shape " + format_shape(array) + "; (N, 3) or (3,) was expected"});
  return array;
}

std::vector<Vec3> to_points(const Points& given, const std::string& what) {
  const NumberArray array = to_rows(given, what);
  std::vector<Vec3> points(static_cast<std::size_t>(array.size() / 3));
  const double* from = array.data();
  for (Vec3& p : points) p = {from[0], from[1], from[2]}, from += 3;
  return points;
}

Vec3 to_vec3(const Points& array, const std::string& what) {
  const std::vector<Vec3> points = to_points(array, what);
  if (points.size() != 1) throw Failure(Error{what + " is several points; one, (3,), was expected"});
  return points[0];
}

py::array_t<double> to_array(const std::vector<Vec3>& points) {
  py::array_t<double> array({static_cast<py::ssize_t>(points.size()), py::ssize_t(3)});
  double* to = array.mutable_data();
  for (const Vec3& p : points)
    for (int i = 0; i < 3; ++i) *to++ = p[i];
  return array;
}

scene::Scene to_scene(const py::object& what, const py::object& fields) {
  std::vector<scene::FieldOverride> given;
  for (const auto& [key, value] : fields.is_none() ? py::dict() : py::dict(fields)) {
    if (!py::isinstance<py::str>(key)) throw Failure(Error{"fields: " + py::cast<std::string>(py::repr(key)) + " is no name"});
    const std::string name = py::cast<std::string>(key);
    given.push_back({name, {}, {}, to_field(value, name).any});
  }
  if (py::isinstance<Field>(what) || py::isinstance<py::array>(what)) {
    if (!given.empty()) throw Failure(Error{"a field alone has no use for others; a scene was expected with them"});
    const Field field = to_field(what, "field");
    const py::gil_scoped_release unlocked;
    return unwrap(scene::scene_for_field(field.any));
  }
  if (py::isinstance<py::dict>(what)) {
    const std::string text = py::cast<std::string>(py::module_::import("catena").attr("_text_of_scene")(what));
    const py::gil_scoped_release unlocked;
    return unwrap(scene::parse_scene_object(text, "scene", given));
  }
  const std::string path = to_path(what);
  const py::gil_scoped_release unlocked;
  if (path.ends_with(".json")) return unwrap(scene::read_scene(path, given));
  if (!given.empty()) throw Failure(Error{path + ": a data file has no use for other fields; a scene was expected with them"});
  return unwrap(scene::scene_for_file(path));
}

}  // namespace catena::python

PYBIND11_MODULE(_catena, m) {
  namespace py = pybind11;
  using catena::python::Failure;
  m.doc() = "See and feel scientific fields: the parts of Catena's library.";
  m.attr("__version__") = catena::kVersion;
  static const py::object error = py::reinterpret_borrow<py::object>(PyErr_NewExceptionWithDoc(
      "catena.Error", "What was given cannot be used: the one line that the program catena would print.", PyExc_ValueError, nullptr));
  static const py::object machine_error = py::reinterpret_borrow<py::object>(PyErr_NewExceptionWithDoc(
      "catena.MachineError", "This machine does not give what is needed (memory, a Vulkan device).", error.ptr(), nullptr));
  m.attr("Error") = error;
  m.attr("MachineError") = machine_error;
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Failure& failure) {
      // make it one line, whatever text it contains; replace the command-line flag by the Python function
      std::string line = failure.message;
      constexpr std::string_view kFlag = "--memory ";
      if (const auto at = line.find(kFlag); at != std::string::npos) {
        const std::size_t number = at + kFlag.size(), end = std::min(line.find_first_of(" )", number), line.size());
        line.replace(at, end - at, "catena.memory_limit(" + line.substr(number, end - number) + ")");
      }
      std::replace_if(
          line.begin(), line.end(), [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; }, '?');
      const auto text =
          py::reinterpret_steal<py::object>(PyUnicode_DecodeUTF8(line.data(), static_cast<py::ssize_t>(line.size()), "backslashreplace"));
      PyErr_SetObject((failure.machine ? machine_error : error).ptr(), text.ptr());
    }
  });
  catena::python::add_fields(m);
  catena::python::add_arrays(m);
  catena::python::add_curves(m);
  catena::python::add_chain(m);
  catena::python::add_images(m);
  catena::python::add_measurements(m);
  catena::python::add_tables(m);
}
