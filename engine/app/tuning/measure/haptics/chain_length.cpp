// SPDX-License-Identifier: MIT
/// Cost of each link of the chain: the scene's chain truncated after 1, 2, ... links.
#include <fmt/format.h>

#include "engine/app/tuning/measure/haptics/link_replay.h"
#include "engine/app/tuning/measure/registry.h"

namespace catena::app::tuning {

Result<std::vector<Curve>> measure_chain_length(Workload& subject) {
  const std::size_t links = subject.program->scene_link_count();
  Curve curve;
  curve.id = "hand-chain";
  curve.title = "Length of the chain";
  curve.description =
      "The scene's chain, cut off after the first link, the second link, and so on: the forces differ, so that there is a cost but no "
      "error.";
  curve.work_name = "field fetches per tick";
  curve.time_name = "ns per tick";
  curve.extra_columns = {"fraction of the tick period, %"};
  const std::vector<haptics::ProbeSample> path = subject.motion.samples(subject.rate_hz);
  std::vector<haptics::HapticProgram> programs;
  for (std::size_t n = 1; n <= links; ++n) {
    haptics::HapticProgram part = without_widgets(*subject.program);
    part.links.resize(n);
    programs.push_back(std::move(part));
    double fetches = 0;
    run_ticks(programs.back(), path, [&](const HapticState& out) {
      for (int i = 0; i < out.link_count; ++i) fetches += out.links[static_cast<std::size_t>(i)].evaluations;
    });
    Point p{fmt::format("{} link{}, up to \"{}\"", n, n > 1 ? "s" : "", subject.program->links[n - 1].name),
            "",
            "",
            kNotMeasured,
            fetches / static_cast<double>(path.size()),
            {},
            kNotMeasured,
            {0}};
    curve.points.push_back(std::move(p));
  }
  if (programs.empty()) return std::vector<Curve>{};
  std::vector<TimedRun> repeats;
  for (const haptics::HapticProgram& program : programs) repeats.push_back(make_tick_run(program, path));
  CATENA_CHECK(time_points(curve, repeats, subject.effort.haptics_s));
  for (Point& p : curve.points) p.extra_values[0] = 100e-9 * p.time.median * subject.rate_hz;
  curve.current = static_cast<int>(links) - 1;
  curve.choice_reason = fmt::format("The whole chain takes {:.2g} us, {:.2g} % of a tick at {:g} Hz.",
                                    1e-3 * curve.points.back().time.median, curve.points.back().extra_values[0], subject.rate_hz);
  return std::vector<Curve>{curve};
}

}  // namespace catena::app::tuning
