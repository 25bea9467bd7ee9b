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

haptics::Program only_link(const haptics::Program& program, const std::string& name,
                           std::shared_ptr<const haptics::Constraint> constraint) {
  haptics::Program one = program;
  std::erase_if(one.links, [&](const haptics::Link& link) { return link.name != name; });
  one.modes.clear();
  one.widgets.clear();
  one.widget_names.clear();
  one.first_widget_link = -1;
  one.coupling.method = haptics::CouplingMethod::chain;
  for (haptics::Link& link : one.links) {
    link.on = {};
    if (constraint) link.constraint = constraint;
  }
  return one;
}

field::VectorFieldPtr vector_field_of(scene::Scene& scene, const json::Node& link) {
  const json::Node* name = link.find("field");
  if (name == nullptr || name->kind != json::Kind::string) return nullptr;
  const auto any = scene::use_field(scene, name->string, *name);
  return any ? any->vector : nullptr;
}

field::ScalarFieldPtr scalar_field_of(scene::Scene& scene, const json::Node& link) {
  const json::Node* name = link.find("field");
  if (name == nullptr || name->kind != json::Kind::string) return nullptr;
  const auto any = scene::use_field(scene, name->string, *name);
  return any ? any->scalar : nullptr;
}

}  // namespace catena::app::tradeoff
