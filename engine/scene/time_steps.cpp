// SPDX-License-Identifier: MIT
#include "engine/scene/time_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>

#include "engine/scene/derived_fields.h"

namespace catena::scene {
namespace {

/// Calls `visit` with each mesh, each curve set and each point set.
template <class S, class Visit>
void each_shape(S& scene, const Visit& visit) {
  scene.entities.template each<MeshSource>([&](Entity, auto& shape) { visit(shape); });
  scene.entities.template each<CurvesSource>([&](Entity, auto& shape) { visit(shape); });
  scene.entities.template each<PointsSource>([&](Entity, auto& shape) { visit(shape); });
}

int steps_of(const FieldSource& source) {
  if (source.has_own_step || !source.file) return 1;
  if (!source.series.empty()) return static_cast<int>(source.series.size());
  return std::max(1, static_cast<int>(step_times(source).size()));
}

/// Returns the time stated in each file; for files that would take long to read only in the first and the last one; empty if a file states
/// none.
std::vector<double> times_of_files(const std::vector<std::string>& files) {
  constexpr std::uint64_t kMaxBytes = 64 << 20, kBytesOfStart = 1 << 20;  // starting a reader takes as long as reading a megabyte
  std::uint64_t bytes = 0;
  for (const std::string& file : files) {
    std::error_code code;
    const std::uintmax_t size = std::filesystem::file_size(file, code);
    bytes += kBytesOfStart + (code ? 0 : size);
  }
  const std::vector<std::string> files_to_read = bytes <= kMaxBytes ? files : std::vector<std::string>{files.front(), files.back()};
  std::vector<double> times;
  for (const std::string& file : files_to_read)
    if (const std::vector<double> file_times = field::read_times(file); !file_times.empty()) times.push_back(file_times.front());
  return times.size() == files_to_read.size() ? times : std::vector<double>();
}

}  // namespace

TimeSteps list_time_steps(const std::string& path, const field::AnyField& loaded) {
  TimeSteps list{1, loaded.times, loaded.time_unit};
  if (is_pattern(path)) {
    const std::vector<std::string> files = expand_pattern(path);
    list.count = static_cast<int>(files.size());
    list.times = times_of_files(files);
    return list;
  }
  if (list.times.empty()) list.times = field::read_times(path);
  list.count = std::max(1, static_cast<int>(list.times.size()));
  return list;
}

field::LoadRequest request_at(field::LoadRequest request, int step) {
  request.step = step;
  if (!is_pattern(request.path)) return request;
  const std::vector<std::string> files = expand_pattern(request.path);
  request.step = 0;
  if (!files.empty()) request.path = files[std::min(static_cast<std::size_t>(step), files.size() - 1)];
  return request;
}

field::LoadRequest request_at(const std::string& path, int step) {
  field::LoadRequest request;
  request.path = path;
  return request_at(std::move(request), step);
}

int step_count(const Scene& scene) {
  int max_steps = 1;
  scene.entities.each<FieldSource>([&](Entity, const FieldSource& source) { max_steps = std::max(max_steps, steps_of(source)); });
  each_shape(scene, [&](const auto& shape) {
    max_steps = std::max(max_steps, static_cast<int>(std::max(shape.steps.series.size(), shape.steps.times.size())));
  });
  return max_steps > 1 ? max_steps : std::max(1, scene.time.steps);
}

std::optional<StepTime> current_step_time(const Scene& scene) {
  std::optional<StepTime> time;
  const auto step = static_cast<std::size_t>(scene.time.step);
  scene.entities.each<FieldSource>([&](Entity, const FieldSource& source) {
    // each file of a pattern has its own time
    const std::span<const double> times = source.series.empty() ? step_times(source) : source.loaded.times;
    const std::size_t at = source.series.empty() ? step : 0;
    if (!time && !source.has_own_step && at < times.size() && step < static_cast<std::size_t>(steps_of(source)))
      time = {times[at], source.loaded.time_unit};
  });
  each_shape(scene, [&](const auto& shape) {
    if (!time && step < shape.steps.times.size()) time = {shape.steps.times[step], {}};
  });
  if (const TimeLine& line = scene.time; !time && line.steps > 1 && step_count(scene) == line.steps)
    time = {line.range[0] + (line.range[1] - line.range[0]) * std::min(scene.time.step, line.steps - 1) / (line.steps - 1), {}};
  return time;
}

std::span<const double> step_times(const FieldSource& source) {
  if (!source.known_times.empty()) return source.known_times;
  const std::span<const double> times(source.loaded.times);
  return source.follows && times.size() > 1 ? times.first(times.size() - 1) : times;  // the newest may be incomplete
}

void request_step_times(FileSteps& steps, const std::string& path) {
  if (!steps.times.empty() || !steps.series.empty()) return;
  steps.times = field::read_times(path);
  if (steps.follows && steps.times.size() > 1) steps.times.pop_back();  // it may be incomplete
}

void assign_step(FieldSource& source, int step) {
  if (source.has_own_step || !source.file) return;
  if (source.series.empty())
    source.file->step = step;
  else
    source.file->path = source.series[static_cast<std::size_t>(std::min(step, static_cast<int>(source.series.size()) - 1))];
}

std::string format_time(const Scene& scene) {
  if (step_count(scene) < 2) return {};
  const auto time = current_step_time(scene);
  if (!time) return fmt::format("step {}", scene.time.step);
  return fmt::format("{:.6g}{}{}", time->value, time->unit.empty() ? "" : " ", time->unit);
}

std::string substitute_time(std::string title, const Scene& scene) {
  const auto replace = [&](std::string_view placeholder, const auto& text) {
    for (std::size_t at = title.find(placeholder); at != std::string::npos; at = title.find(placeholder, at)) {
      const std::string value = text();
      title.replace(at, placeholder.size(), value);
      at += value.size();
    }
  };
  replace("{time}", [&] { return format_time(scene); });
  replace("{step}", [&] { return std::to_string(std::min(scene.time.step, step_count(scene) - 1)); });
  return title;
}

bool set_step(Scene& scene, int step) {
  if (scene.time.step == step) return false;
  scene.time.step = step;
  bool changed = false;
  scene.entities.each<FieldSource>([&](Entity, FieldSource& source) {
    if (!source.file) return;
    const field::LoadRequest before = *source.file;
    const std::size_t times = step_times(source).size();
    assign_step(source, step);
    // a file without steps stays unchanged
    const bool same = *source.file == before || (source.series.empty() && source.loaded.get() != nullptr && times < 2);
    if (same) return;
    source.loaded = source.rendered = {};
    source.has_changed_step = true;
    changed = true;
  });
  each_shape(scene, [&](auto& shape) {
    if (!assign_step(shape, step)) return;
    shape.loaded = {};
    changed = true;
  });
  changed = drop_derived(scene) || changed;
  if (changed) scene.cache = EntityStore{};
  return changed;
}

std::vector<field::LoadRequest> prefetch_requests(const Scene& scene, int step) {
  std::vector<field::LoadRequest> requests;
  scene.entities.each<FieldSource>([&](Entity, const FieldSource& source) {
    if (source.loaded.get() == nullptr || steps_of(source) < 2) return;
    FieldSource future = source;
    assign_step(future, step);
    requests.push_back(*future.file);
  });
  return requests;
}

}  // namespace catena::scene
