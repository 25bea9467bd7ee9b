#include "engine/app/tradeoff/measure/hand/replay_link.h"

#include <memory>

#include "engine/base/clock.h"

namespace catena::app::tradeoff {

void run_ticks(const haptics::Program& program, std::span<const haptics::ProbeSample> path,
               const std::function<void(const exchange::HapticState&)>& look) {
  auto state = std::make_unique<haptics::ChainState>();
  auto scratch = std::make_unique<haptics::ChainScratch>();
  exchange::HapticState out;
  for (const haptics::ProbeSample& probe : path) {
    haptics::tick(program, probe, *state, *scratch, out);
    if (look) look(out);
  }
}

Repeat ticks_of(const haptics::Program& program, std::span<const haptics::ProbeSample> path) {
  return [&program, path]() -> Result<double> {
    const std::int64_t start = processor_ns();
    run_ticks(program, path, {});
    return static_cast<double>(processor_ns() - start) / static_cast<double>(path.size());
  };
}

haptics::Program without_widgets(const haptics::Program& program) {
  haptics::Program bare = program;
  bare.first_widget_link = -1;
  bare.widgets.clear();
  bare.widget_names.clear();
  bare.modes.clear();
  return bare;
}

haptics::Program only_link(const haptics::Program& program, const std::string& name,
                           std::shared_ptr<const haptics::Constraint> constraint) {
  haptics::Program one = without_widgets(program);
  std::erase_if(one.links, [&](const haptics::Link& link) { return link.name != name; });
  one.coupling.method = haptics::CouplingMethod::chain;
  for (haptics::Link& link : one.links) {
    link.on = {};
    if (constraint) link.constraint = constraint;
  }
  return one;
}

Result<std::vector<Curve>> curves_of_links(Subject& subject, const std::string& type, const std::string& what,
                                           Result<Curve> (*measure)(Subject& subject, const LinkOf& link)) {
  std::vector<Curve> curves;
  for (const LinkOf& link : links_of_type(subject.scene, type)) {
    auto curve = measure(subject, link);
    if (curve)
      curves.push_back(std::move(*curve));
    else
      subject.left_out.push_back(what + ": " + curve.error().message + ".");
  }
  return curves;
}

}  // namespace catena::app::tradeoff
