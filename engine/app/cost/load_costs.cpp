#include <fmt/format.h>

#include "engine/app/cost/cost.h"
#include "engine/base/clock.h"

namespace catena::app {
namespace {

constexpr int kLattice = 24;  // nodes an axis, that a formula is timed on

/// Of sampling a formula at `resolution`^3 nodes.
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

}  // namespace

Outcome add_load_costs(scene::Scene& scene, scene::Scene* fresh, CostTable& table) {
  std::vector<scene::Entity> sources;
  scene.world.each<scene::FieldSource>([&](scene::Entity e, const scene::FieldSource& source) {
    if (source.loaded.get() != nullptr) sources.push_back(e);
  });
  for (const scene::Entity e : sources) {
    const scene::FieldSource& source = scene.world.get<scene::FieldSource>(e);
    const std::string name = scene.world.get<scene::Name>(e).value;
    const bool sampled = source.drawn.get() != nullptr && source.drawn.get() != source.loaded.get();
    CostRow row{"load", name, "", {}, {}};
    row.expected.bytes = double(source.loaded.get()->bytes() + (sampled ? source.drawn.get()->bytes() : 0));
    row.work = sampled                          ? fmt::format("a formula on {0} x {0} x {0} nodes", source.resolution)
               : source.loaded.get()->is_grid() ? "a grid"
                                                : "a formula";
    if (!source.loaded.get()->is_grid()) row.expected.ms = sampled ? expected_ms(source) : 0;
    if (fresh != nullptr) {
      const scene::Entity same = scene::find_field(*fresh, name);
      const json::Node where = fresh->world.get<scene::FieldSource>(same).where;
      const std::int64_t start = now_ns();
      CATENA_CHECK(scene::use_field(*fresh, same, where));
      const scene::FieldSource& loaded = fresh->world.get<scene::FieldSource>(same);
      if (sampled) {
        CATENA_TRY(const field::AnyField drawn, field::try_sample_on_grid(loaded.loaded, loaded.resolution, loaded.box[0], loaded.box[1]));
        row.measured.bytes = double(loaded.loaded.get()->bytes() + drawn.get()->bytes());
      } else {
        row.measured.bytes = double(loaded.loaded.get()->bytes());
      }
      row.measured.ms = ms_since(start);
    }
    table.push_back(std::move(row));
  }
  return Done{};
}

}  // namespace catena::app
