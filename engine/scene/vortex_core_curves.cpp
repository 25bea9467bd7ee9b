// SPDX-License-Identifier: MIT
#include "engine/scene/vortex_core_curves.h"

#include <algorithm>
#include <cmath>

#include "engine/base/system_failure.h"
#include "engine/base/text.h"

namespace catena::scene {
namespace {

/// Returns vortex core lines as curves with the swirl at each point; points are added between knots until the chord error is at most
/// kSagitta.
Result<curves::CurveSetPtr> curves_of(const flow::VortexCores& cores, const VortexCoreCurves& traced) {
  constexpr double kSagitta = 1e-6;  // fraction of L
  constexpr double kMaxParts = 16;
  std::size_t max_points = 0;
  for (const flow::CurvePtr& line : cores.lines) max_points += line->knots().size() * static_cast<std::size_t>(kMaxParts);
  CATENA_TRY(curves::CurveSetBuilder builder, curves::CurveSetBuilder::create("vortex cores of " + traced.field, max_points, {"swirl"}));
  for (std::size_t k = 0; k < cores.lines.size(); ++k) {
    const flow::Curve& line = *cores.lines[k];
    const std::vector<flow::Knot>& knots = line.knots();
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
      const double length = knots[i + 1].s - knots[i].s, sagitta = norm(knots[i + 1].t - knots[i].t) * length / 8;
      const double parts = std::clamp(std::ceil(std::sqrt(sagitta / (kSagitta * line.domain_length()))), 1.0, kMaxParts);
      for (double part = 0; part < parts; ++part) {
        Vec3 position, derivative;
        line.evaluate_interval(i, knots[i].s + length * (part / parts), position, derivative);
        const float swirl = std::lerp(cores.swirls[k][i], cores.swirls[k][i + 1], static_cast<float>(part / parts));
        if (!builder.add(position, &swirl)) return Error{"is too far from the origin; coordinates up to 1e15 were expected"};
      }
    }
    builder.add(knots.back().p, &cores.swirls[k].back());
    builder.end_line();
  }
  CATENA_TRY(curves::CurveSet set, builder.finish());
  return curves::CurveSetPtr(std::make_shared<curves::CurveSet>(std::move(set)));
}

}  // namespace

Result<curves::CurveSetPtr> resolve_vortex_core_curves(Scene& scene, Entity entity) {
  const VortexCoreCurves traced = *scene.entities.get<CurvesSource>(entity).vortex_cores;
  CATENA_TRY(const field::AnyField any, resolve_field(scene, traced.field, traced.where));
  const auto core_error = [&](const Error& error) {
    return with_cause(json::error_at(traced.where, "curves " + in_quotes(scene.entities.get<Name>(entity).value) + ": field " +
                                                       in_quotes(traced.field) + " " + error.message),
                      error);
  };
  if (!any.vector) return core_error(Error{"is a scalar field; a vector field was expected"});
  const auto cores = flow::find_vortex_cores(any.vector, traced.options);
  if (!cores) return core_error(cores.error());
  CurvesSource& source = scene.entities.get<CurvesSource>(entity);
  if (source.loaded && traced.cores == *cores) return source.loaded;
  if ((*cores)->holds_everywhere)
    return core_error(Error{"satisfies the criterion everywhere, so that there is no core line; another \"criterion\" was expected"});
  if ((*cores)->lines.empty())
    return core_error(Error{"has no vortex core of sufficient length by this criterion; a rotating flow was expected"});
  auto set = curves_of(**cores, traced);
  if (!set) return core_error(set.error());
  source.vortex_cores->cores = *cores;
  source.loaded = *set;
  return source.loaded;
}

}  // namespace catena::scene
