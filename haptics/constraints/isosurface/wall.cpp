#include "haptics/constraints/isosurface/wall.h"

#include "engine/field/grid.h"
#include "haptics/constraints/isosurface/reach.h"

namespace catena::haptics {
namespace {

constexpr double kBefore = 1e-9;      // voxels: where the wall of an invalid cell is held
constexpr double kLevelSlack = 1e-9;  // of L: as good as on the level
constexpr int kKept = 4;              // fetches, to look at what was found

}  // namespace

AtWall onto_level(LevelField& field, const Vec3& probe, const ClosestGoal& goal, const field::Index3& base, const Vec3& f) noexcept {
  const double slack = kLevelSlack * field.length();
  const field::ScalarGrid& grid = *field.grid();
  const field::Mapping& mapping = grid.mapping();
  const field::Box& box = grid.index_box();
  const Vec3 place = Vec3(base.x, base.y, base.z) + f;
  Vec3 index = place;
  unsigned held = 0;
  for (int a = 0; a < 3; ++a) {
    if (!(box.hi[a] > box.lo[a]) || (f[a] != 0 && f[a] != 1)) continue;
    // on the side of the cell that the walk was in
    const bool end = place[a] <= box.lo[a] || place[a] >= box.hi[a];
    if (!end) index[a] += f[a] == 0 ? kBefore : -kBefore;
    Vec3 beyond = Vec3(base.x, base.y, base.z) + glm::clamp(f, Vec3(1e-3), Vec3(1 - 1e-3));
    beyond[a] = place[a] + (f[a] == 0 ? -0.5 : 0.5);
    field.count_fetch();
    if (end || grid.why_outside(mapping.world_from_index(beyond), field.cursor()) != Reason::none) held |= 1u << a;
  }
  if (held == 7) return {};
  LevelField wall = field;
  wall.keep(kKept);
  wall.hold(held, index);
  LevelPoint at = wall.at(mapping.world_from_index(index));
  if (!at.valid || at.plateau) return {};
  if (std::fabs(at.distance) > std::max(1e-12 * field.length(), at.round_off)) {
    const Reached reached = reach_along_gradient(wall, at, at.n, 2 * field.voxel(), 0);
    if (!reached.found) return {};
    at = reached.at;
  }
  if (held != 0) {
    LevelPoint closest = at;
    Curvature curvature;
    closest_point(wall, wall.on_wall(probe), goal, closest, curvature);
    if (closest.valid && std::fabs(closest.distance) <= slack && norm(probe - closest.p) < norm(probe - at.p)) at = closest;
  }
  const LevelPoint free = field.at(at.p);
  return {free.valid && !free.plateau && std::fabs(free.distance) <= slack, free};
}

}  // namespace catena::haptics
