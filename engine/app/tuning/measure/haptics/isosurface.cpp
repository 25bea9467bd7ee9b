// SPDX-License-Identifier: MIT
/// Accuracy of an isosurface link on the given grid and on coarser grids. The link has no setting of its own: it iterates
/// until the remaining tangential distance is below 1e-8 L (haptics/constraints/isosurface).
///   error  root mean square of |s(p) - level| / |grad s| in the given field over the ticks in contact, by L
#include <fmt/format.h>

#include <cmath>

#include "engine/app/tuning/measure/discretization_error.h"
#include "engine/app/tuning/measure/haptics/link_replay.h"
#include "engine/app/tuning/measure/registry.h"
#include "haptics/constraints/registry.h"

namespace catena::app::tuning {
namespace {

/// Builds the constraint of a link on another field.
Result<std::shared_ptr<const haptics::Constraint>> link_on(Workload& subject, const json::Node& node, const field::ScalarFieldPtr& field,
                                                           const std::string& name) {
  haptics::BuildContext context;
  context.field = [&](const json::Node& where, const std::string& wanted) -> Result<field::AnyField> {
    if (wanted == name) return field::AnyField{field, nullptr};
    return scene::resolve_field(subject.scene, wanted, where);
  };
  return haptics::build_constraint(node, context);
}

Result<Curve> measure_surface(Workload& subject, const NamedLink& link) {
  const field::ScalarFieldPtr field = find_link_field(subject.scene, link.node).scalar;
  const json::Node* level = link.node.find("level");
  if (!field || level == nullptr || level->kind != json::Kind::number)
    return Error{"link \"" + link.name + "\" has no field with a stated level"};
  const auto motion = motion_through_surface(subject.scene, link, subject.effort.motion_s);
  if (!motion) return Error{"no path from the faces of the domain to the middle meets the level of link \"" + link.name + "\""};
  Curve curve;
  curve.id = "hand-isosurface-" + link.name;
  curve.title = "Accuracy of the surface link \"" + link.name + "\"";
  curve.description = fmt::format(
      "The probe moves {} ({:g} Hz). The link has no setting for the accuracy: in each tick the search of the proxy continues until the "
      "remaining distance along the surface is below 1e-8 L.",
      motion->description, subject.rate_hz);
  curve.error_name = "distance of the proxy from the surface / L (RMS)";
  curve.work_name = "field fetches per tick";
  curve.time_name = "ns per tick";
  curve.bytes_name = "bytes of the field";
  curve.extra_columns = {"ticks that hold"};
  curve.reference = "the level of the field at full resolution, which is known everywhere";
  std::vector<field::ScalarFieldPtr> fields{field};
  if (field->grid() != nullptr) {
    if (const auto levels = make_resolution_levels(*field->grid())) {
      fields.insert(fields.end(), {levels->grids[1], levels->grids[2]});
      curve.description += " For comparison, the same link on every 2nd and every 4th voxel.";
    }
  } else {
    curve.discretization_error_method = "The field is a formula without discretization error.";
  }
  const std::vector<haptics::ProbeSample> path = motion->samples(subject.rate_hz);
  std::vector<haptics::HapticProgram> programs;
  const char* words[] = {"full resolution", "every 2nd voxel", "every 4th voxel"};
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const json::Node* name = link.node.find("field");
    CATENA_TRY(auto constraint, link_on(subject, link.node, fields[i], name->string));
    programs.push_back(isolate_link(*subject.program, link.name, std::move(constraint)));
    Point p{words[i], "", i == 0 ? "full resolution" : "coarser", 0, 0, {}, static_cast<double>(fields[i]->bytes()), {0}};
    if (fields[i]->bytes() == 0) p.bytes = kNotMeasured;
    field::Cursor cursor;
    double squares = 0, fetches = 0;
    run_ticks(programs.back(), path, [&](const HapticState& out) {
      const LinkReport& report = out.links[0];
      fetches += report.evaluations;
      if (report.status != LinkStatus::ok) return;
      const field::ScalarSample s = field->sample(report.proxy, cursor);
      const double slope = norm(s.gradient);
      if (!s.inside || !(slope > 0)) return;
      const double off = (s.value - level->number) / slope / field->domain_length();
      squares += off * off;
      ++p.extra_values[0];
    });
    p.error = p.extra_values[0] > 0 ? std::sqrt(squares / p.extra_values[0]) : kNotMeasured;
    p.work = fetches / static_cast<double>(path.size());
    p.extra_values[0] /= static_cast<double>(path.size());
    curve.points.push_back(std::move(p));
  }
  if (!(curve.points[0].extra_values[0] > 0)) return Error{"link \"" + link.name + "\" is never in contact along this motion"};
  curve.current = 0;
  if (curve.points.size() == 3) {
    const ExtrapolatedError e = extrapolate_from_differences(curve.points[1].error, curve.points[2].error);
    curve.discretization_error = e.error;
    if (!e.is_converged) curve.discretization_error_name += ", at least";
    curve.discretization_error_method = fmt::format("from the surfaces of every 2nd and every 4th voxel; {}", describe_order(e));
  }
  std::vector<TimedRun> repeats;
  for (const haptics::HapticProgram& program : programs) repeats.push_back(make_tick_run(program, path));
  CATENA_CHECK(time_points(curve, repeats, subject.effort.haptics_s));
  return curve;
}

}  // namespace

Result<std::vector<Curve>> measure_isosurface(Workload& subject) {
  return measure_links(subject, "isosurface", "Accuracy of a surface link", measure_surface);
}

}  // namespace catena::app::tuning
