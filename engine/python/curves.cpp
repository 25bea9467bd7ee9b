// SPDX-License-Identifier: MIT
/// catena.trace: streamlines through seeds, the same curves that the haptic links use and the image shows.
#include <cmath>

#include "engine/geometry/flow/curve.h"
#include "engine/python/module.h"

namespace catena::python {
namespace {

struct Curve {
  flow::CurvePtr curve;
};

template <class Get>
py::array_t<double> of_knots(const Curve& curve, Get get) {
  std::vector<Vec3> all;
  for (const flow::Knot& knot : curve.curve->knots()) all.push_back(get(knot));
  return to_array(all);
}

std::vector<Curve> trace(const Field& field, const Points& seeds, double length, bool line, double min_speed, double tolerance) {
  if (!field.any.vector) throw Failure(Error{"a scalar field has no streamlines; a vector field was expected"});
  const std::vector<Vec3> places = to_points(seeds, "seeds");
  for (const auto& [what, value] : {std::pair{"length", length}, {"min_speed", min_speed}, {"tolerance", tolerance}})
    if (!(value >= 0) || !std::isfinite(value))
      throw Failure(Error{std::string(what) + " is " + std::to_string(value) + "; a finite number, 0 or more, was expected"});
  const py::gil_scoped_release unlocked;
  flow::TraceOptions options;
  options.length = length;
  if (tolerance > 0) options.tolerance = tolerance, options.hermite_tolerance = 0.1 * tolerance;
  std::vector<Curve> curves;
  for (std::size_t i = 0; i < places.size(); ++i) {
    auto traced = flow::trace({field.any.vector.get(), line, min_speed}, places[i], options);
    if (!traced) throw Failure(Error{"seeds[" + std::to_string(i) + "]: " + traced.error().message});
    curves.push_back({std::move(*traced)});
  }
  return curves;
}

py::array_t<double> at(const Curve& curve, const py::object& lengths) {
  const NumberArray s = to_numbers(lengths, "s");
  std::vector<Vec3> places;
  for (py::ssize_t i = 0; i < s.size(); ++i) places.push_back(curve.curve->position(s.data()[i]));
  return to_array(places);
}

}  // namespace

void add_curves(py::module_& m) {
  py::class_<Curve>(m, "Curve", "A streamline by arc length: knots, and a cubic between two of them.")
      .def_property_readonly(
          "points", [](const Curve& c) { return of_knots(c, [](const flow::Knot& k) { return k.p; }); },
          "(K, 3): places of the knots, world units.")
      .def_property_readonly(
          "tangents", [](const Curve& c) { return of_knots(c, [](const flow::Knot& k) { return k.t; }); },
          "(K, 3): unit tangents at the knots.")
      .def_property_readonly(
          "s",
          [](const Curve& c) {
            py::array_t<double> s(static_cast<py::ssize_t>(c.curve->knots().size()));
            double* to = s.mutable_data();
            for (const flow::Knot& k : c.curve->knots()) *to++ = k.s;
            return s;
          },
          "(K,): arc length of the knots from the seed, signed, world units.")
      .def_property_readonly(
          "closed", [](const Curve& c) { return c.curve->is_closed(); }, "True where it came back to its seed.")
      .def_property_readonly(
          "ends",
          [](const Curve& c) {
            return py::make_tuple(flow::to_string(c.curve->first_end().termination), flow::to_string(c.curve->last_end().termination));
          },
          "How it ends upstream and downstream: BOUNDARY, CRITICAL, LENGTH, LAP or INCOHERENT.")
      .def(
          "at", at, py::arg("s"),
          "Places at arc lengths.\n\ns: (N,), world units.\nReturns (N, 3); beyond the ends the ends, round and round where it is closed.");
  m.def("trace", trace, py::arg("field"), py::arg("seeds"), py::arg("length") = 0.0, py::arg("line") = false, py::arg("min_speed") = 0.0,
        py::arg("tolerance") = 0.0,
        "Streamlines of a vector field, both ways from every seed.\n\nseeds: (N, 3) or (3,), world units. length: the longest way each "
        "way, world units; 0: ten times the domain.\nline: v and -v mean the same (fibres). min_speed: slower counts as zero, field units. "
        "tolerance: error of a step, of the domain's length; 0: 1e-10.\nReturns a list of N curves. A seed that starts nothing raises "
        "Error.");
}

}  // namespace catena::python
