// SPDX-License-Identifier: MIT
#include "engine/app/render/frame_stats.h"

#include <fmt/core.h>

#include <set>

#include "engine/base/json_text.h"
#include "engine/base/numbers.h"

namespace catena::app {

namespace {

/// [{"grid": "density", "factor": 2}, ..]
std::string coarsening_json(const std::vector<render::GridDownsampling>& list) {
  std::string text = "[";
  for (const render::GridDownsampling& one : list)
    text += fmt::format("{}{{\"grid\": {}, \"factor\": {}}}", text.size() > 1 ? ", " : "", json_string(one.grid), one.factor);
  return text + "]";
}

}  // namespace

double FrameStats::median_ms() const {
  std::vector<double> times = frame_ms;
  return quantile(times, 0.5);
}

std::string FrameStats::to_json() const {
  std::vector<double> times = frame_ms;
  return fmt::format(
      "{{\n  \"device\": {},\n  \"driver\": {},\n  \"frames\": {},\n"
      "  \"frame_ms\": {{\"median\": {:.3f}, \"p99\": {:.3f}, \"max\": {:.3f}}},\n"
      "  \"first_frame_ms\": {:.3f},\n  \"load_ms\": {:.3f},\n  \"mirror_ms\": {:.3f},\n  \"choose_ms\": {:.3f},\n  "
      "\"encode_ms\": {:.3f},\n"
      "  \"quality\": {{\"mode\": {}, \"estimated_rmse\": {}}},\n"
      "  \"tiles\": {},\n  \"objects\": {},\n"
      "  \"mirror_coarsening\": {},\n"
      "  \"cpu_bytes\": {},\n  \"gpu_bytes\": {},\n  \"gpu_budget_bytes\": {},\n  \"validation_messages\": {}\n}}\n",
      json_string(device), json_string(driver), frame_ms.size(), median_ms(), quantile(times, 0.99), quantile(times, 1), first_frame_ms,
      load_ms, residency_ms, settings_search_ms, encode_ms, json_string(quality_mode),
      estimated_rmse ? fmt::format("{:.4f}", *estimated_rmse) : std::string("null"), tiles, objects_json(objects),
      coarsening_json(downsampled_grids), cpu_bytes, gpu_bytes, gpu_budget_bytes, validation_messages);
}

std::string objects_json(const std::vector<render::ObjectName>& objects) {
  std::string text = "[";
  for (const render::ObjectName& object : objects)
    text += fmt::format("{}{{\"id\": {}, \"kind\": {}, \"name\": {}}}", text.size() > 1 ? ", " : "", object.id, json_string(object.kind),
                        json_string(object.name));
  return text + "]";
}

std::uint64_t loaded_data_bytes(const scene::Scene& scene) {
  std::set<const field::Field*> counted;
  std::uint64_t bytes = 0;
  const auto add = [&](const field::AnyField& any) {
    if (any.get() != nullptr && counted.insert(any.get()).second) bytes += any.get()->bytes();
  };
  scene.entities.each<scene::FieldSource>([&](scene::Entity, const scene::FieldSource& source) {
    add(source.loaded);
    add(source.rendered);
  });
  scene.entities.each<scene::MeshSource>([&](scene::Entity, const scene::MeshSource& source) {
    if (source.loaded) bytes += source.loaded->bytes();
  });
  scene.entities.each<scene::PointsSource>([&](scene::Entity, const scene::PointsSource& source) {
    if (source.loaded) bytes += source.loaded->bytes();
  });
  scene.entities.each<scene::CurvesSource>([&](scene::Entity, const scene::CurvesSource& source) {
    if (source.loaded) bytes += source.loaded->bytes();
  });
  return bytes;
}

}  // namespace catena::app
