// SPDX-License-Identifier: MIT
/// Makes the scene of a trial, as JSON text: the task's template with the condition's chain in it. These strings in the study file are
/// placeholders for values of the trial (lengths and positions in world units):
///   "$seed"  integer: seed of the stimulus's field            "$lines"  [[x, y, z], ...]: seed point of each global line
///   "$start" "$middle" "$end"  [x, y, z]: points of the path  "$line_length"  maximum length of a global line in each direction
///   "$path"  [[x, y, z], ...]: points of the path             "$radius"  radius of the circle target
///   "$length" "$half_length"  length of the path, half of it  "$ground"  z of the path's end
///   "$indicator"  length of the local indicator
/// Every part of the text is on the same line as in the study file, so that errors name that line.
#pragma once
#include <string>

#include "engine/study/session.h"
#include "engine/study/stimulus.h"

namespace catena::study {

/// The complete scene of a trial. An array item for which a placeholder gives an empty list of points is omitted.
std::string make_trial_scene(const Study& study, const Trial& trial, const Stimulus& stimulus);
/// The scene with only the fields of a task's template, for `seed`; the other values of a trial are not known at that point.
std::string make_field_scene(const Study& study, const Task& task, int seed);
/// Checks every string that starts with "$". Error: the first one that is not a known placeholder.
Outcome check_placeholders(const json::Node& scene);

}  // namespace catena::study
