#include "engine/app/frame_stats.h"

#include <fmt/core.h>

#include <set>

#include "engine/base/json_text.h"
#include "engine/base/numbers.h"

namespace catena::app {

namespace {

/// [{"grid": "density", "factor": 2}, ..]
std::string coarsening_json(const std::vector<render::MirrorCoarsening>& list) {
  std::string text = "[";
  for (const render::MirrorCoarsening& one : list)
    text += fmt::format("{}{{\"grid\": {}, \"factor\": {}}}", text.size() > 1 ? ", " : "", json_string(one.grid), one.factor);
  return text + "]";
}

}  // namespace

double FrameStats::median_ms() const {
  std::vector<double> times = frame_ms;
  return quantile(times, 0.5);
}

std::string FrameStats::json() const {
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
      load_ms, mirror_ms, choose_ms, encode_ms, json_string(quality_mode),
      estimated_rmse ? fmt::format("{:.4f}", *estimated_rmse) : std::string("null"), tiles, objects_json(objects),
      coarsening_json(mirror_coarsening), cpu_bytes, gpu_bytes, gpu_budget_bytes, validation_messages);
}

std::string objects_json(const std::vector<render::ObjectName>& objects) {
  std::string text = "[";
  for (const render::ObjectName& object : objects)
    text += fmt::format("{}{{\"id\": {}, \"kind\": {}, \"name\": {}}}", text.size() > 1 ? ", " : "", object.id, json_string(object.kind),
                        json_string(object.name));
  return text + "]";
}

std::uint64_t field_bytes(const scene::Scene& scene) {
  std::set<const field::Field*> counted;
  std::uint64_t bytes = 0;
  const auto add = [&](const field::AnyField& any) {
    if (any.get() != nullptr && counted.insert(any.get()).second) bytes += any.get()->bytes();
  };
  scene.world.each<scene::FieldSource>([&](scene::Entity, const scene::FieldSource& source) {
    add(source.loaded);
    add(source.drawn);
  });
  scene.world.each<scene::MeshSource>([&](scene::Entity, const scene::MeshSource& source) {
    if (source.loaded) bytes += source.loaded->bytes();
  });
  scene.world.each<scene::DrawnPoints>([&](scene::Entity, const scene::DrawnPoints& source) {
    if (source.loaded) bytes += source.loaded->bytes();
  });
  scene.world.each<scene::DrawnCurves>([&](scene::Entity, const scene::DrawnCurves& source) {
    if (source.loaded) bytes += source.loaded->bytes();
  });
  return bytes;
}

}  // namespace catena::app
