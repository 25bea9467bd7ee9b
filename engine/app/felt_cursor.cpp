#include "engine/app/felt_cursor.h"

#include <memory>

#include "engine/app/probe_samples.h"
#include "engine/scene/systems.h"

namespace catena::app {

namespace {
// a still hand: as many ticks as a distant proxy may need to arrive
std::vector<haptics::ProbeSample> resting_at(const Vec3& probe) {
  std::vector<haptics::ProbeSample> path;
  for (int k = 0; k < 500; ++k) path.push_back({0.001 * k, probe, 0});
  return path;
}
}  // namespace

Outcome place_cursor(scene::Scene& scene, const haptics::Program& program, const std::string& probe_csv) {
  std::vector<haptics::ProbeSample> path;
  if (!probe_csv.empty()) {
    CATENA_TRY(const std::vector<ProbeRow> rows, read_probe_path(probe_csv));
    path = probe_samples(rows);
  } else if (scene.cursor && scene.world.has<scene::Cursor>(scene.cursor) && scene.world.get<scene::Cursor>(scene.cursor).visible) {
    path = resting_at(scene.world.get<scene::Cursor>(scene.cursor).probe);
  } else {
    return Done{};
  }
  auto state = std::make_unique<haptics::ChainState>();
  auto scratch = std::make_unique<haptics::ChainScratch>();
  exchange::HapticState last;
  for (const haptics::ProbeSample& probe : path) haptics::tick(program, probe, *state, *scratch, last);
  scene::update_cursor(scene, last);
  scene::Cursor& cursor = scene.world.get<scene::Cursor>(scene.cursor);
  cursor.names.clear();
  for (const haptics::Link& link : program.links) cursor.names.push_back(link.name);
  return Done{};
}

}  // namespace catena::app
