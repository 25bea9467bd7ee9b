// SPDX-License-Identifier: MIT
/// Runs the real tick of a program along a path, to observe or to time it. Not for the haptic thread.
#pragma once
#include <functional>
#include <span>

#include "engine/app/tuning/measure/timing.h"
#include "engine/app/tuning/measure/workload.h"
#include "engine/scene/scene.h"
#include "haptics/chain/offline_ticks.h"

namespace catena::app::tuning {

/// Runs one tick per sample and calls `on_tick`, if set, after each.
void run_ticks(const haptics::HapticProgram& program, std::span<const haptics::ProbeSample> path,
               const std::function<void(const HapticState&)>& on_tick);

/// Returns a timed run of the whole path: processor time in nanoseconds per tick. `program` and `path` must outlive it.
TimedRun make_tick_run(const haptics::HapticProgram& program, std::span<const haptics::ProbeSample> path);

/// Returns the program without widgets and modes, so that its links can be removed.
haptics::HapticProgram without_widgets(const haptics::HapticProgram& program);

/// Returns the program reduced to the one link, always active, with `constraint` in place of its own if given.
haptics::HapticProgram isolate_link(const haptics::HapticProgram& program, const std::string& name,
                                    std::shared_ptr<const haptics::Constraint> constraint = {});

/// Measures a curve for each link of the given type; a link that cannot be measured adds the sentence "WHAT: reason." to Workload::skipped.
Result<std::vector<Curve>> measure_links(Workload& subject, const std::string& type, const std::string& what,
                                         Result<Curve> (*measure)(Workload& subject, const NamedLink& link));

}  // namespace catena::app::tuning
