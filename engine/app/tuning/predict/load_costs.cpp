// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "engine/app/cli/command.h"
#include "engine/app/tuning/predict/cost.h"
#include "engine/base/clock.h"
#include "engine/io/field_cache.h"

namespace catena::app {
namespace {

constexpr int kLattice = 64;  // nodes per axis of the grid on which a formula is timed: enough to use all cores

/// Expected time of sampling a formula at `resolution`^3 nodes, milliseconds; std::nullopt if it cannot be sampled.
std::optional<double> expected_ms(const scene::FieldSource& source) {
  double quickest = 0;
  for (int k = 0; k < 3; ++k) {
    const std::int64_t start = now_ns();
    if (!field::try_sample_on_grid(source.loaded, kLattice, source.box[0], source.box[1])) return std::nullopt;
    const double ms = ms_since(start);
    quickest = k == 0 ? ms : std::min(quickest, ms);
  }
  const double nodes = double(source.resolution) * source.resolution * source.resolution;
  return quickest * nodes / (double(kLattice) * kLattice * kLattice);
}

/// Loads one field of a scene of which nothing is loaded, and samples it if it is rendered from a grid.
Result<ResourceCost> load_once(const std::string& path, const std::string& name, bool sampled) {
  field::clear_cache();  // otherwise a series would reuse its cached steps
  const std::int64_t opened = now_ns();
  CATENA_TRY(scene::Scene fresh, open_scene(path));
  const scene::Entity e = scene::find_field(fresh, name);
  const json::Node where = fresh.entities.get<scene::FieldSource>(e).where;
  // a data file is loaded when it is opened, the fields of a scene when they are first requested
  const std::int64_t start = is_scene_file(path) ? now_ns() : opened;
  CATENA_CHECK(scene::resolve_field(fresh, e, where));
  const scene::FieldSource& source = fresh.entities.get<scene::FieldSource>(e);
  ResourceCost cost{double(source.loaded.get()->bytes()), {}};
  if (sampled) {
    CATENA_TRY(const field::AnyField drawn, field::try_sample_on_grid(source.loaded, source.resolution, source.box[0], source.box[1]));
    *cost.bytes += double(drawn.get()->bytes());
  }
  cost.ms = ms_since(start);
  return cost;
}

}  // namespace

Outcome add_load_costs(const std::string& path, const scene::Scene& scene, bool measure, CostTable& table) {
  std::vector<scene::Entity> sources;
  scene.entities.each<scene::FieldSource>([&](scene::Entity e, const scene::FieldSource& source) {
    if (source.loaded.get() != nullptr) sources.push_back(e);
  });
  for (const scene::Entity e : sources) {
    const scene::FieldSource& source = scene.entities.get<scene::FieldSource>(e);
    const std::string name = scene.entities.get<scene::Name>(e).value;
    const bool sampled = source.rendered.get() != nullptr && source.rendered.get() != source.loaded.get();
    CostRow row{"load", name, "", {}, {}};
    row.expected.bytes = double(source.loaded.get()->bytes() + (sampled ? source.rendered.get()->bytes() : 0));
    row.work = sampled                          ? fmt::format("a formula on {0} x {0} x {0} nodes", source.resolution)
               : source.loaded.get()->is_grid() ? "a grid"
                                                : "a formula";
    if (sampled) {
      row.expected.ms = expected_ms(source);
    } else {
      CATENA_TRY(const ResourceCost once, load_once(path, name, sampled));
      row.expected.ms = once.ms;
    }
    if (measure) {
      CATENA_TRY(row.measured, load_once(path, name, sampled));
    }
    table.push_back(std::move(row));
  }
  return Done{};
}

}  // namespace catena::app
