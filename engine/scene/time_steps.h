/// Steps in time. A field, a mesh, curves or points whose file has several, or whose "file" is a pattern (the files in the order of the
/// numbers in their names, engine/base/natural_sort.h), follows the scene's step; a field that states a step of its own does not. Outliers
/// the last step of one its last one stands. Frame thread.
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

/// Steps of a data file: of one that is loaded already, or of a mesh, curves or points, which are none.
TimeSteps list_time_steps(const std::string& path, const field::AnyField& loaded);

/// What a request for a file, or for a pattern, reads at a step; beyond the last file of a pattern the last.
field::LoadRequest request_at(field::LoadRequest request, int step);
/// The same by the path alone.
field::LoadRequest request_at(const std::string& path, int step);

/// Of the field with most; 1: nothing changes. Steps within a file are known once it is loaded.
int step_count(const Scene& scene);
/// A step's time, where a file states it.
struct StepTime {
  double value = 0;
  std::string unit;  ///< "s", "hours since 2001-01-01"; empty: not stated
};
/// Of the scene's step, once its fields are loaded.
std::optional<StepTime> current_step_time(const Scene& scene);
/// "0.25 s"; where no file states a time "step 3"; empty: nothing has steps.
std::string format_time(const Scene& scene);
/// A title with `{time}` and `{step}` in it as it is shown: format_time() and the step's number stand for them.
std::string substitute_time(std::string title, const Scene& scene);

/// Fields that follow change their source, and what was made of the scene is dropped. Nothing is loaded. False: nothing changes.
bool set_step(Scene& scene, int step);
/// What the fields that are loaded now will need at that step, so that it can be loaded ahead (engine/io/field_cache.h).
std::vector<field::LoadRequest> prefetch_requests(const Scene& scene, int step);

/// Private to this room: the source of one field at a step, and its times as far as they are known.
void assign_step(FieldSource& source, int step);
std::span<const double> step_times(const FieldSource& source);
/// Asks for the times of the steps within the file of a mesh, curves or points, once that is loaded.
void request_step_times(FileSteps& steps, const std::string& path);
/// assign_step of a mesh, curves or points. True: another file or step is to be loaded.
template <class Shape>
bool assign_step(Shape& shape, int step) {
  FileSteps& steps = shape.steps;
  const int before = std::exchange(steps.step, step);
  if (steps.series.empty()) return before != step && steps.times.size() > 1;
  const std::string& path = steps.series[std::min(static_cast<std::size_t>(step), steps.series.size() - 1)];
  return std::exchange(shape.path, path) != path;
}

}  // namespace catena::scene
