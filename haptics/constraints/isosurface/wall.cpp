#include "haptics/constraints/isosurface/wall.h"

#include "engine/field/grid.h"
#include "haptics/constraints/equations.h"

namespace catena::haptics {
namespace {

constexpr double kOnWall = 1e-8;      // voxels: a place on the wall
constexpr double kBefore = 1e-9;      // voxels: where the wall of an invalid cell is held
constexpr double kNear = 1;           // voxels: a wall that may have stopped a search
constexpr double kLevelSlack = 1e-9;  // of L: as good as on the level

struct Wall {
  int axis = -1;
  double index = 0;  ///< where the axis is held
  double way = 0;    ///< to it, times the step
  Reason reason = Reason::none;
  bool up = false;  ///< toward higher indices
};

/// The first wall on the way from `index` along `step`, at most kNear voxels ahead, that is not held yet.
Wall first_wall(LevelField& field, const Vec3& index, const Vec3& step) noexcept {
  const field::ScalarGrid& grid = *field.grid();
  const field::Box& box = grid.index_box();
  Wall first;
  for (int a = 0; a < 3; ++a) {
    if ((field.held() >> a & 1) != 0 || step[a] == 0 || !(box.hi[a] > box.lo[a])) continue;
    const bool up = step[a] > 0;
    // the face ahead of the place; one that it lies on counts as ahead
    const double face = up ? std::floor(index[a] - kOnWall) + 1 : std::ceil(index[a] + kOnWall) - 1;
    const double way = std::max(0.0, (face - index[a]) / step[a]);
    if (!(std::fabs(face - index[a]) <= kNear) || (first.axis >= 0 && way >= first.way)) continue;
    const bool end = up ? face >= box.hi[a] : face <= box.lo[a];
    if (end) {
      first = {a, up ? box.hi[a] : box.lo[a], way, Reason::box, up};
      continue;
    }
    Vec3 beyond = index + step * way;
    beyond[a] = face + (up ? 0.5 : -0.5);
    const Reason reason = grid.why_outside(field.field().mapping().world_from_index(beyond), field.cursor());
    field.count_fetch();
    if (reason != Reason::none && reason != Reason::box) first = {a, up ? face - kBefore : face + kBefore, way, reason, up};
  }
  return first;
}

/// The way to the closest point along the surface, in voxels.
Vec3 step_of(const LevelField& field, const LevelPoint& at, const Vec3& probe) noexcept {
  const Vec3 e = field.on_wall(probe) - at.p;
  return field.field().mapping().index_from_world_linear * equation::tangential(e, at.n);
}

}  // namespace

bool pushes_out(LevelField& field, const LevelPoint& at, const Vec3& probe) noexcept {
  if (!at.valid || at.plateau) return false;
  const Vec3 index = field.field().mapping().index_from_world(at.p);
  const Wall wall = first_wall(field, index, step_of(field, at, probe));
  return wall.axis >= 0 && wall.way <= 1;
}

AtWall closest_at_wall(LevelField& field, const Vec3& probe, const ClosestGoal& goal, const LevelPoint& start) noexcept {
  const field::Mapping& mapping = field.field().mapping();
  const double slack = kLevelSlack * field.length();
  AtWall answer;
  LevelField wall = field;  // counts into the same state
  LevelPoint at = start;
  Vec3 held_at(0.0), outward(0.0);
  for (int faces = 0; faces < 2; ++faces) {
    const Vec3 index = mapping.index_from_world(at.p);
    const Wall ahead = first_wall(wall, index, step_of(wall, at, probe));
    if (ahead.axis < 0) break;
    held_at[ahead.axis] = ahead.index;
    outward[ahead.axis] = ahead.up ? 1 : -1;
    wall.hold(wall.held() | 1u << ahead.axis, held_at);
    at = wall.at(at.p);
    if (!at.valid || at.plateau) return {};
    Curvature curvature;
    answer.reason = ahead.reason;
    if (closest_point(wall, wall.on_wall(probe), goal, at, curvature) != Closest::converged) continue;
    const LevelPoint free = field.at(at.p);
    if (!free.valid || free.plateau || std::fabs(free.distance) > slack) return {};
    // a search that could go on inwards, or was nearer before, has not met this wall
    const Vec3 left = step_of(field, free, probe);
    for (int a = 0; a < 3; ++a)
      if ((wall.held() >> a & 1) != 0 && left[a] * outward[a] < 0) return {};
    if (std::fabs(start.distance) <= slack && norm(probe - free.p) > norm(probe - start.p) + slack) return {};
    answer.at = free;
    answer.found = true;
    return answer;
  }
  return {};
}

}  // namespace catena::haptics
