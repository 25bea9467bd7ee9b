/// A trial as a scene: the task's template with the condition's chain in it, as JSON text. These strings stand for values of the trial:
///   "$seed"  a whole number: of the stimulus's field        "$lines"  [[x, y, z], ...]: a place of each global line
///   "$start" "$middle" "$end"  [x, y, z]: of the path       "$context_length"  world: of a global line, each way
///   "$path"  [[x, y, z], ...]                               "$radius"  world: of the circle
///   "$length" "$half_length"  world: of the path            "$ground"  z of the end
///   "$indicator"  world: of the local indicator
/// Every part of the text stands on the line that it has in the study file, so that errors name that line.
#pragma once
#include <string>

#include "engine/study/session.h"
#include "engine/study/stimulus.h"

namespace catena::study {

std::string make_trial_scene(const Study& study, const Trial& trial, const Stimulus& stimulus);
/// The fields of a task's template alone, with this seed; no other value of a trial is known yet.
std::string make_field_scene(const Study& study, const Task& task, int seed);
/// "$start" and so on stand for something; else an error at the first that does not.
Outcome check_placeholders(const json::Node& scene);

}  // namespace catena::study
