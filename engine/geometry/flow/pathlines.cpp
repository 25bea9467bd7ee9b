// SPDX-License-Identifier: MIT
#include "engine/geometry/flow/pathlines.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/base/numbers.h"
#include "engine/geometry/flow/pathline_particles.h"

namespace catena::flow {

Result<std::vector<Result<CurvePtr>>> trace_pathlines(const UnsteadyField& field, std::span<const Vec3> seeds,
                                                      const PathlineOptions& options) {
  if (seeds.size() > options.max_all_knots / 2)
    return Error{fmt::format("there are {} seeds; at most {} were expected", seeds.size(), options.max_all_knots / 2)};
  std::vector<Particle> particles(seeds.size());
  for (std::size_t i = 0; i < seeds.size(); ++i) particles[i] = {seeds[i], options.start, true};
  CATENA_TRY(const double length, move_particles(field, particles, options.end,
                                                 {options.tolerance, options.max_knots, options.max_all_knots, options.progress}));
  std::vector<Result<CurvePtr>> curves;
  curves.reserve(seeds.size());
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    Particle& particle = particles[i];
    const std::string at = fmt::format("seed ({}, {}, {})", to_text(seeds[i].x), to_text(seeds[i].y), to_text(seeds[i].z));
    if (particle.knots.empty()) {
      curves.emplace_back(Error{fmt::format("{} is outside the domain of {} at time {}", at, field.name, to_text(options.start))});
      continue;
    }
    if (particle.s < 1e-10 * length || particle.knots.size() < 2) {
      curves.emplace_back(Error{fmt::format("{}: {} does not move a particle there", at, field.name)});
      continue;
    }
    const LineEnd end = particle.end.value_or(LineEnd(Termination::time));
    if (options.end < options.start) {
      std::ranges::reverse(particle.knots);
      std::ranges::reverse(particle.times);
      for (Knot& knot : particle.knots) {
        knot.s = -knot.s;
        knot.t = -knot.t;
      }
      curves.emplace_back(
          std::make_shared<const Curve>(std::move(particle.knots), false, end, Termination::time, length, std::move(particle.times)));
    } else {
      curves.emplace_back(
          std::make_shared<const Curve>(std::move(particle.knots), false, Termination::time, end, length, std::move(particle.times)));
    }
    particle = {};
  }
  return curves;
}

}  // namespace catena::flow
