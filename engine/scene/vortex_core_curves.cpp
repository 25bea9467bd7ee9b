// SPDX-License-Identifier: MIT
#include "engine/scene/vortex_core_curves.h"

#include <algorithm>
#include <cmath>

#include "engine/base/system_failure.h"
#include "engine/base/text.h"

namespace catena::scene {
namespace {

/// Vortex core lines as curves with the swirl at each point; points are added between knots until the chord error is at most kSagitta.
Result<curves::CurveSetPtr> curves_of(const flow::VortexCores& cores, const VortexCoreCurves& traced) {
  constexpr double kSagitta = 1e-6;  // of L
  constexpr double kMostParts = 16;
  std::size_t most = 0;
  for (const flow::CurvePtr& line : cores.lines) most += line->knots().size() * static_cast<std::size_t>(kMostParts);
  CATENA_TRY(curves::CurveSetBuilder builder, curves::CurveSetBuilder::create("vortex cores of " + traced.field, most, {"swirl"}));
  for (std::size_t k = 0; k < cores.lines.size(); ++k) {
    const flow::Curve& line = *cores.lines[k];
    const std::vector<flow::Knot>& knots = line.knots();
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
      const double length = knots[i + 1].s - knots[i].s, sagitta = norm(knots[i + 1].t - knots[i].t) * length / 8;
      const double parts = std::clamp(std::ceil(std::sqrt(sagitta / (kSagitta * line.domain_length()))), 1.0, kMostParts);
      for (double part = 0; part < parts; ++part) {
        Vec3 place, derivative;
        line.evaluate_interval(i, knots[i].s + length * (part / parts), place, derivative);
        const float swirl = std::lerp(cores.swirls[k][i], cores.swirls[k][i + 1], static_cast<float>(part / parts));
        if (!builder.add(place, &swirl)) return Error{"lies too far from the origin; places up to 1e15 were expected"};
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
  const auto wrong = [&](const Error& error) {
    return with_cause(json::error_at(traced.where, "curves " + in_quotes(scene.entities.get<Name>(entity).value) + ": field " +
                                                       in_quotes(traced.field) + " " + error.message),
                      error);
  };
  if (!any.vector) return wrong(Error{"is a scalar field; a vector field was expected"});
  const auto cores = flow::find_vortex_cores(any.vector, traced.options);
  if (!cores) return wrong(cores.error());
  CurvesSource& source = scene.entities.get<CurvesSource>(entity);
  if (source.loaded && traced.cores == *cores) return source.loaded;
  if ((*cores)->holds_everywhere)
    return wrong(Error{"satisfies the criterion everywhere, so that no place is a core; another \"criterion\" was expected"});
  if ((*cores)->lines.empty()) return wrong(Error{"has no vortex core by this criterion, or none so long; a flow that turns was expected"});
  auto set = curves_of(**cores, traced);
  if (!set) return wrong(set.error());
  source.vortex_cores->cores = *cores;
  source.loaded = *set;
  return source.loaded;
}

}  // namespace catena::scene
