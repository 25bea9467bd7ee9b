// SPDX-License-Identifier: MIT
#include "engine/app/tuning/measure/haptics/link_replay.h"

#include <memory>

#include "engine/base/clock.h"

namespace catena::app::tuning {

void run_ticks(const haptics::HapticProgram& program, std::span<const haptics::ProbeSample> path,
               const std::function<void(const HapticState&)>& on_tick) {
  auto state = std::make_unique<haptics::ChainState>();
  auto scratch = std::make_unique<haptics::ChainScratch>();
  haptics::OfflineTicks ticks;
  HapticState out;
  for (const haptics::ProbeSample& probe : path) {
    ticks.run(program, probe, *state, *scratch, out);
    if (on_tick) on_tick(out);
  }
}

TimedRun make_tick_run(const haptics::HapticProgram& program, std::span<const haptics::ProbeSample> path) {
  return [&program, path]() -> Result<double> {
    const std::int64_t start = process_cpu_ns();
    run_ticks(program, path, {});
    return static_cast<double>(process_cpu_ns() - start) / static_cast<double>(path.size());
  };
}

haptics::HapticProgram without_widgets(const haptics::HapticProgram& program) {
  haptics::HapticProgram bare = program;
  bare.first_widget_link = -1;
  bare.widgets.clear();
  bare.widget_names.clear();
  bare.modes.clear();
  return bare;
}

haptics::HapticProgram isolate_link(const haptics::HapticProgram& program, const std::string& name,
                                    std::shared_ptr<const haptics::Constraint> constraint) {
  haptics::HapticProgram one = without_widgets(program);
  std::erase_if(one.links, [&](const haptics::Link& link) { return link.name != name; });
  one.coupling.method = CouplingMethod::chain;
  for (haptics::Link& link : one.links) {
    link.active_when = {};
    if (constraint) link.constraint = constraint;
  }
  return one;
}

Result<std::vector<Curve>> measure_links(Workload& subject, const std::string& type, const std::string& what,
                                         Result<Curve> (*measure)(Workload& subject, const NamedLink& link)) {
  std::vector<Curve> curves;
  for (const NamedLink& link : find_links(subject.scene, type)) {
    auto curve = measure(subject, link);
    if (curve)
      curves.push_back(std::move(*curve));
    else
      subject.skipped.push_back(what + ": " + curve.error().message + ".");
  }
  return curves;
}

}  // namespace catena::app::tuning
