// SPDX-License-Identifier: MIT
/// catena.Field and catena.analytic: values and gradients at many points at a time.
#include <limits>
#include <optional>

#include "engine/field/analytic/analytic.h"
#include "engine/field/derived/derive.h"
#include "engine/field/derived/node_function.h"
#include "engine/io/volume/load_field.h"
#include "engine/python/module.h"

namespace catena::python {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

py::array_t<double> sample(const Field& field, const Points& points) {
  const std::vector<Vec3> places = to_points(points, "points");
  const auto count = static_cast<py::ssize_t>(places.size());
  py::array_t<double> values = field.any.vector ? py::array_t<double>({count, py::ssize_t(3)}) : py::array_t<double>(count);
  double* to = values.mutable_data();
  const py::gil_scoped_release unlocked;
  field::Cursor cursor;
  for (const Vec3& p : places) {
    if (field.any.vector) {
      const field::VectorSample s = field.any.vector->sample(p, cursor);
      for (int i = 0; i < 3; ++i) *to++ = s.inside ? s.value[i] : kNan;
    } else {
      const field::ScalarSample s = field.any.scalar->sample(p, cursor);
      *to++ = s.inside ? s.value : kNan;
    }
  }
  return values;
}

py::array_t<double> gradient(const Field& field, const Points& points) {
  if (!field.any.scalar) throw Failure(Error{"a vector field has no gradient here; a scalar field was expected"});
  std::vector<Vec3> places = to_points(points, "points");
  {
    const py::gil_scoped_release unlocked;
    field::Cursor cursor;
    for (Vec3& p : places) {
      const field::ScalarSample s = field.any.scalar->sample(p, cursor);
      p = s.inside ? s.gradient : Vec3(kNan);
    }
  }
  return to_array(places);
}

Field analytic(const std::string& name, double scale, const std::string& part, const Points& center) {
  field::AnalyticParameters parameters;
  parameters.scale = scale;
  parameters.part = part;
  parameters.center = to_vec3(center, "center");
  return {unwrap(field::make_analytic(name, parameters))};
}

Field derived(const Field& field, const std::string& quantity, int order) {
  if (order != 2 && order != 4) throw Failure(Error{"order: 2 or 4 was expected"});
  const field::Quantity found = unwrap(field::find_quantity(quantity));
  const py::gil_scoped_release unlocked;
  return {unwrap(field::derive(field.any, found, order, quantity))};
}

Field component(const Field& field, int component) {
  if (component < 0 || component > 2) throw Failure(Error{"component: 0, 1 or 2 was expected"});
  const py::gil_scoped_release unlocked;
  return {unwrap(field::derive_component(field.any, component, field.any.get()->name()))};
}

Field smoothed(const Field& field, double sigma) {
  if (!(sigma > 0)) throw Failure(Error{"sigma: a number > 0 was expected"});
  const py::gil_scoped_release unlocked;
  return {unwrap(field::smooth(field.any, sigma, field.any.get()->name()))};
}

Field resampled(const Field& field, const Field& on) {
  if (!on.any.get()->is_grid()) throw Failure(Error{"on: a formula has no nodes; a grid was expected"});
  const py::gil_scoped_release unlocked;
  return {unwrap(field::resample(field.any, {on.any}, field.any.get()->name()))};
}

void save(const Field& field, const py::object& to) {
  const std::string path = to_path(to);
  if (!field.any.get()->is_grid()) throw Failure(Error{"a formula has no voxels to write; a grid was expected"});
  const py::gil_scoped_release unlocked;
  unwrap(field::write_vdb(path, {{field.any, field.any.get()->name()}}));
}

std::string text(const Field& field) {
  return "<catena.Field " + field.any.get()->name() + (field.any.vector ? ", vectors" : ", scalars") +
         (field.any.get()->is_grid() ? ", a grid>" : ", a formula>");
}

}  // namespace

void add_fields(py::module_& m) {
  py::class_<Field>(
      m, "Field",
      "A scalar or vector field in world coordinates: a grid, or a formula. It does not change; any number of threads may use it.")
      .def("sample", sample, py::arg("points"),
           "Values at world places.\n\npoints: (N, 3) or (3,), world units.\nReturns (N,) of a scalar field, (N, 3) of a vector field "
           "(components along the world's axes), in the field's unit;\nNaN outside of the domain.")
      .def("gradient", gradient, py::arg("points"),
           "Gradients of a scalar field at world places: exact derivatives of what sample() gives.\n\npoints: (N, 3) or (3,), world "
           "units.\nReturns (N, 3), field units per world unit; NaN outside of the domain.")
      .def(
          "derived", derived, py::arg("quantity"), py::arg("order") = 2,
          "A quantity of the field: \"gradient\", \"vorticity\", \"q_criterion\", ... (docs/reference/derived.md). Of a grid at its nodes, "
          "of a formula at any place.\n\norder: of the differences between nodes, 2 or 4.")
      .def("component", component, py::arg("component"), "A component of a vector field: 0, 1 or 2, along the world's axes.")
      .def("smoothed", smoothed, py::arg("sigma"), "A grid smoothed by a Gaussian.\n\nsigma: standard deviation, world units.")
      .def("resampled", resampled, py::arg("on"), "The field at the nodes of another one, which is a grid.")
      .def("save", save, py::arg("path"), "Writes a grid to a .vdb file, whole or not at all.")
      .def_property_readonly(
          "name", [](const Field& f) { return f.any.get()->name(); }, "The grid's or the formula's name.")
      .def_property_readonly(
          "is_vector", [](const Field& f) { return f.any.vector != nullptr; }, "True for three components a place.")
      .def_property_readonly(
          "is_grid", [](const Field& f) { return f.any.get()->is_grid(); }, "False for formulas.")
      .def_property_readonly(
          "bounds",
          [](const Field& f) {
            const Bounds b = f.any.get()->world_bounds();
            return to_array({b.lo, b.hi});
          },
          "(2, 3): the lowest and the highest corner of the domain's box, world units.")
      .def_property_readonly(
          "range",
          [](const Field& f) -> py::object {
            if (f.any.scalar) return py::make_tuple(f.any.scalar->min_value(), f.any.scalar->max_value());
            if (const field::VectorGrid* grid = f.any.vector->grid()) return py::make_tuple(grid->min_magnitude(), grid->max_magnitude());
            return py::none();
          },
          "(least, most) of the values; of a vector grid of their lengths; None for a vector formula.")
      .def_property_readonly(
          "bytes", [](const Field& f) { return f.any.get()->bytes(); }, "Memory that the grid holds, bytes.")
      .def("__repr__", text);
  m.def("analytic", analytic, py::arg("name"), py::arg("scale") = 1.0, py::arg("part") = "", py::arg("center") = std::array<double, 3>{},
        "A field by formula: \"sphere\", \"helix\", \"hill\", \"left-ventricle\", ... (analytic_names()).\n\nscale: multiplies values. "
        "part: of \"left-ventricle\": density, transmural or fibre. center: (3,), world place of the formula's origin.");
  m.def(
      "memory_limit",
      [](std::optional<double> megabytes) {
        if (megabytes && !(*megabytes > 0 && *megabytes <= 1e12))
          throw Failure(Error{"memory_limit: expected from 1e-6 to 1e12 MB, or None"});
        set_memory_limit(megabytes ? std::optional(static_cast<std::uint64_t>(1e6 * *megabytes)) : std::nullopt);
      },
      py::arg("megabytes"),
      "Lets data take so many megabytes from now on; None: three quarters of what is free, as at the start.\n\nWhat needs more raises "
      "Error before it is read.");
  m.def(
      "analytic_names",
      [] {
        std::vector<std::string> names;
        for (const std::string_view name : field::analytic_names()) names.emplace_back(name);
        return names;
      },
      "The names that analytic() takes.");
}

}  // namespace catena::python
