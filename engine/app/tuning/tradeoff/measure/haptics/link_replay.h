/// The very tick of a program along a path, looked at or timed. Off the haptic thread.
#pragma once
#include <functional>
#include <span>

#include "engine/app/tuning/tradeoff/measure/timing.h"
#include "engine/app/tuning/tradeoff/measure/workload.h"
#include "engine/scene/scene.h"
#include "haptics/chain/tick.h"

namespace catena::app::tradeoff {

/// Calls `look` after every tick.
void run_ticks(const haptics::HapticProgram& program, std::span<const haptics::ProbeSample> path,
               const std::function<void(const HapticState&)>& look);

/// A repeat that runs the whole path and gives the processor's nanoseconds a tick. Both outlive it.
TimedRun make_tick_run(const haptics::HapticProgram& program, std::span<const haptics::ProbeSample> path);

/// The program without what a person can hold or switch: its links may be taken out.
haptics::HapticProgram without_widgets(const haptics::HapticProgram& program);

/// The program with one link alone, another constraint in its place where `constraint` is given.
haptics::HapticProgram isolate_link(const haptics::HapticProgram& program, const std::string& name,
                                    std::shared_ptr<const haptics::Constraint> constraint = {});

/// A curve for each link of the scene of a type; of one that cannot be measured the sentence "WHAT: why." in left_out.
Result<std::vector<Curve>> measure_links(Workload& subject, const std::string& type, const std::string& what,
                                         Result<Curve> (*measure)(Workload& subject, const NamedLink& link));

}  // namespace catena::app::tradeoff
