/// The very tick of a program along a path, looked at or timed. Off the haptic thread.
#pragma once
#include <functional>
#include <span>

#include "engine/app/tradeoff/measure/timing.h"
#include "engine/scene/scene.h"
#include "haptics/chain/tick.h"

namespace catena::app::tradeoff {

/// Calls `look` after every tick.
void run_ticks(const haptics::Program& program, std::span<const haptics::ProbeSample> path,
               const std::function<void(const exchange::HapticState&)>& look);

/// A repeat that runs the whole path and gives the processor's nanoseconds a tick. Both outlive it.
Repeat ticks_of(const haptics::Program& program, std::span<const haptics::ProbeSample> path);

/// The program with one link alone, another constraint in its place where `constraint` is given.
haptics::Program only_link(const haptics::Program& program, const std::string& name,
                           std::shared_ptr<const haptics::Constraint> constraint = {});

/// The field that an item of the chain names; nothing where it is another kind.
field::VectorFieldPtr vector_field_of(scene::Scene& scene, const json::Node& link);
field::ScalarFieldPtr scalar_field_of(scene::Scene& scene, const json::Node& link);

}  // namespace catena::app::tradeoff
