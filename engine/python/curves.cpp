// SPDX-License-Identifier: MIT
/// catena.trace and catena.trace_unsteady: lines through seeds, the same curves that the haptic links use and the image shows.
#include <cmath>

#include "engine/geometry/flow/curve.h"
#include "engine/geometry/flow/pathlines.h"
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

std::vector<std::vector<Curve>> trace_unsteady(const std::vector<Field>& steps, const std::vector<double>& times, const Points& seeds,
                                               const std::string& lines, std::optional<double> start, std::optional<double> end,
                                               bool cubic) {
  const std::vector<Vec3> places = to_points(seeds, "seeds");
  if (steps.size() < 2 || times.size() != steps.size()) throw Failure(Error{"two or more steps, and as many times, were expected"});
  if (lines != "path" && lines != "streak") throw Failure(Error{"lines is \"" + lines + "\"; path or streak was expected"});
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (!steps[i].any.vector || !steps[i].any.get()->is_grid())
      throw Failure(Error{"steps[" + std::to_string(i) + "] is no vector grid; vector grids were expected"});
    if (!std::isfinite(times[i]) || (i > 0 && !(times[i] > times[i - 1])))
      throw Failure(Error{"times[" + std::to_string(i) + "] does not rise; rising finite times were expected"});
  }
  flow::PathlineOptions options;
  options.start = start.value_or(times.front());
  options.end = end.value_or(times.back());
  for (const double time : {options.start, options.end})
    if (!(time >= times.front() && time <= times.back())) throw Failure(Error{"start and end within the times were expected"});
  if (options.start == options.end || (lines == "streak" && options.end < options.start))
    throw Failure(Error{"an end other than the start, and for streak lines after it, was expected"});
  flow::UnsteadyField field;
  field.name = "the field";
  field.times = times;
  field.is_cubic_in_time = cubic;
  field.load = [&](std::size_t step) -> Result<field::VectorFieldPtr> { return steps[step].any.vector; };
  const py::gil_scoped_release unlocked;
  std::vector<std::vector<Curve>> lists;
  const auto add = [&](std::size_t i, const auto& result, const auto& take) {
    if (!result) throw Failure(Error{"seeds[" + std::to_string(i) + "]: " + result.error().message});
    take(lists.emplace_back(), *result);
  };
  if (lines == "path") {
    const auto traced = flow::trace_pathlines(field, places, options);
    if (!traced) throw Failure(traced.error());
    for (std::size_t i = 0; i < places.size(); ++i)
      add(i, (*traced)[i], [](auto& list, const flow::CurvePtr& curve) { list.push_back({curve}); });
    return lists;
  }
  const auto traced = flow::trace_streaklines(field, places, options);
  if (!traced) throw Failure(traced.error());
  for (std::size_t i = 0; i < places.size(); ++i)
    add(i, (*traced)[i], [](auto& list, const std::vector<flow::CurvePtr>& pieces) {
      for (const flow::CurvePtr& piece : pieces) list.push_back({piece});
    });
  return lists;
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
          "times",
          [](const Curve& c) { return py::array_t<double>(static_cast<py::ssize_t>(c.curve->times().size()), c.curve->times().data()); },
          "(K,): times of the knots of a path line or streak line; empty for a streamline.")
      .def_property_readonly(
          "closed", [](const Curve& c) { return c.curve->is_closed(); }, "True where it came back to its seed.")
      .def_property_readonly(
          "ends",
          [](const Curve& c) {
            return py::make_tuple(flow::to_string(c.curve->first_end().termination), flow::to_string(c.curve->last_end().termination));
          },
          "How it ends upstream and downstream: BOUNDARY, CRITICAL, LENGTH, LAP, INCOHERENT or TIME.")
      .def(
          "at", at, py::arg("s"),
          "Places at arc lengths.\n\ns: (N,), world units.\nReturns (N, 3); beyond the ends the ends, round and round where it is closed.");
  m.def("trace", trace, py::arg("field"), py::arg("seeds"), py::arg("length") = 0.0, py::arg("line") = false, py::arg("min_speed") = 0.0,
        py::arg("tolerance") = 0.0,
        "Streamlines of a vector field, both ways from every seed.\n\nseeds: (N, 3) or (3,), world units. length: the longest way each "
        "way, world units; 0: ten times the domain.\nline: v and -v mean the same (fibres). min_speed: slower counts as zero, field units. "
        "tolerance: error of a step, of the domain's length; 0: 1e-10.\nReturns a list of N curves. A seed that starts nothing raises "
        "Error.");
  m.def("trace_unsteady", trace_unsteady, py::arg("steps"), py::arg("times"), py::arg("seeds"), py::arg("lines") = "path",
        py::arg("start") = py::none(), py::arg("end") = py::none(), py::arg("cubic") = false,
        "Path lines or streak lines of a flow that changes with time.\n\nsteps: vector grids over the same nodes. times: rising, one per "
        "step. seeds: (N, 3) or (3,), world units.\nlines: path or streak. start, end: release and end of the path (the end may be "
        "first), or first release and time of the streak line; None: the first and last time. cubic: interpolation between steps.\n"
        "Returns a list of N lists of curves: one path each, or the pieces of a streak line. A seed that starts nothing raises Error.");
}

}  // namespace catena::python
