// SPDX-License-Identifier: MIT
/// Time steps. A field, mesh, curves or points whose file has several steps, or whose "file" is a pattern (files in the order of the
/// numbers in their names, engine/base/natural_sort.h), follows the scene's current step; a field that states its own step does not. Beyond
/// the last step of a source its last one is used. Frame thread.
#pragma once
#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/scene/file_pattern.h"
#include "engine/scene/scene.h"

namespace catena::scene {

/// Returns the time steps of a data file or pattern. `loaded`: the field if it is loaded; empty for meshes, curves and points.
TimeSteps list_time_steps(const std::string& path, const field::AnyField& loaded);

/// Returns the request for one step of a file or pattern; beyond the last file of a pattern, the last file.
field::LoadRequest request_at(field::LoadRequest request, int step);
/// Returns the request for one step of a file or pattern that is given by its path alone.
field::LoadRequest request_at(const std::string& path, int step);

/// Returns the number of steps of the source with the most; 1: nothing changes. The steps within a file are known after it is loaded.
int step_count(const Scene& scene);
/// Time of a step, as stated in a file.
struct StepTime {
  double value = 0;  ///< Time, in `unit`
  std::string unit;  ///< Unit of `value`: "s", "hours since 2001-01-01"; empty: not specified
};
/// Returns the time of the current step; nullopt: no loaded source states one.
std::optional<StepTime> current_step_time(const Scene& scene);
/// Returns "0.25 s"; "step 3" if no file states a time; empty if there is only one step.
std::string format_time(const Scene& scene);
/// Returns the title with `{time}` replaced by format_time() and `{step}` by the number of the current step.
std::string substitute_time(std::string title, const Scene& scene);

/// Sets the current step: changes the sources that follow it, and drops loaded data and the scene's cache accordingly. Loads nothing.
/// Returns false if no source has changed.
bool set_step(Scene& scene, int step);
/// Returns the requests that the loaded fields will need at a step, so that it can be loaded ahead (engine/io/field_cache.h).
std::vector<field::LoadRequest> prefetch_requests(const Scene& scene, int step);

/// Private to this module: sets the source of one field to a step; step_times returns the known times of the steps within its file.
void assign_step(FieldSource& source, int step);
std::span<const double> step_times(const FieldSource& source);
/// Reads the times of the steps within the file of a mesh, curves or points, after it is loaded.
void request_step_times(FileSteps& steps, const std::string& path);
/// Sets a mesh, curves or points to a step. Returns whether another file or step has to be loaded.
template <class Shape>
bool assign_step(Shape& shape, int step) {
  FileSteps& steps = shape.steps;
  const int before = std::exchange(steps.step, step);
  if (steps.series.empty()) return before != step && steps.times.size() > 1;
  const std::string& path = steps.series[std::min(static_cast<std::size_t>(step), steps.series.size() - 1)];
  return std::exchange(shape.path, path) != path;
}

}  // namespace catena::scene
