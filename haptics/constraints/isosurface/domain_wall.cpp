// SPDX-License-Identifier: MIT
#include "haptics/constraints/isosurface/domain_wall.h"

#include "engine/field/grid/grid.h"
#include "haptics/constraints/isosurface/surface_search.h"

namespace catena::haptics {
namespace {

constexpr double kBefore = 1e-9;      // voxels; the proxy is held at this distance from the wall of an invalid cell, on the valid side
constexpr double kLevelSlack = 1e-9;  // fraction of L; tolerance for a point on the level
constexpr double kSomeWay = 1e-6;     // fraction of L; minimum progress toward the probe in a tick
constexpr int kOntoLinear = 5;        // Newton steps
constexpr int kKept = 4;              // field samples reserved for checking the result

/// Returns the cell point of `position`, moved onto the level of the cell's trilinear polynomial, or as close to it as possible within the
/// cell.
CellPoint on_linear_level(LevelSetField& field, const Vec3& position) noexcept {
  const field::Mapping& mapping = field.grid()->mapping();
  CellPoint at = to_cell_point(*field.grid(), position);
  field.count_fetch();
  const field::ScalarCell cell = field.grid()->cell(at.base, field.cursor());
  for (int k = 0; k < kOntoLinear; ++k) {
    double value;
    Vec3 slope;
    cell.value_and_gradient(at.f, value, slope);
    ++field.steps();
    slope = mapping.world_from_index_gradient(slope);
    const double square = dot(slope, slope);
    if (!(square > 0) || !std::isfinite(value)) break;
    at.f = glm::clamp(at.f - mapping.index_from_world_linear * (slope * ((value - field.level()) / square)), Vec3(0.0), Vec3(1.0));
  }
  return at;
}

/// Moves the end point of the walk onto the level of the cubic field; `found` is set if the level is met nearby.
WallResult onto_level(LevelSetField& field, const Vec3& probe, const ClosestPointCriteria& goal, const CellPoint& walked) noexcept {
  const Vec3& f = walked.f;
  const double slack = kLevelSlack * field.length();
  const field::CellField& grid = *field.grid();
  const field::Mapping& mapping = grid.mapping();
  const field::Box& box = grid.index_box();
  const Vec3 corner(walked.base.x, walked.base.y, walked.base.z), position = corner + f;
  Vec3 index = position;
  unsigned held = 0;
  for (int a = 0; a < 3; ++a) {
    if (!(box.hi[a] > box.lo[a]) || (f[a] != 0 && f[a] != 1)) continue;
    // stay in the cell in which the walk ended
    const bool end = position[a] <= box.lo[a] || position[a] >= box.hi[a];
    if (!end) index[a] += f[a] == 0 ? kBefore : -kBefore;
    Vec3 beyond = corner + glm::clamp(f, Vec3(1e-3), Vec3(1 - 1e-3));
    beyond[a] = position[a] + (f[a] == 0 ? -0.5 : 0.5);
    field.count_fetch();
    if (end || grid.status_outside(mapping.world_from_index(beyond), field.cursor()) != SampleStatus::ok) held |= 1u << a;
  }
  if (held == 7) return {};
  LevelSetField wall = field;
  wall.reserve_fetches(kKept);
  wall.constrain_to_wall(held, index);
  LevelPoint at = wall.at(mapping.world_from_index(index));
  if (!at.valid || at.plateau) return {};
  if (std::fabs(at.distance) > std::max(1e-12 * field.length(), at.round_off)) {
    const LevelSetHit reached = search_along_gradient(wall, at, at.n, 2 * field.voxel_edge(), 0);
    if (!reached.found) return {};
    at = reached.point;
  }
  if (held != 0) {
    LevelPoint closest = at;
    Curvature curvature;
    closest_point(wall, wall.project_to_wall(probe), goal, closest, curvature);
    if (closest.valid && std::fabs(closest.distance) <= slack && norm(probe - closest.p) < norm(probe - at.p)) at = closest;
  }
  const LevelPoint free = field.at(at.p);
  return {free.valid && !free.plateau && std::fabs(free.distance) <= slack, free};
}

}  // namespace

WallResult closest_point_at_walls(LevelSetField& field, const PieceFrames& frames, const Vec3& probe, const ClosestPointCriteria& goal,
                                  const LevelPoint& at, const AllowedTravel& travel) noexcept {
  LevelSetField linear = field.with_trilinear_cells();
  linear.reserve_fetches(kWallFetches);
  CellPoint cell = on_linear_level(field, at.p);
  TravelLimit limit{travel.from, travel.max_distance, false, {}, Vec3(0.0)};
  WalkResult walk = walk_cells(linear, frames, probe, cell, &limit);
  if (limit.is_exceeded_by(world_position(*field.grid(), cell))) {
    cell = limit.last_within;
    walk.status = LinkStatus::budget;
  }
  if (walk.status != LinkStatus::boundary && walk.status != LinkStatus::budget) return {};
  WallResult found = onto_level(field, probe, goal, cell);
  const double before = norm(probe - at.p), now = norm(probe - found.point.p);
  if (!found.found || now > before + kLevelSlack * field.length()) return {};
  // a walk that resumes in the next tick must have made some progress
  if (walk.status == LinkStatus::budget && !(before - now > kSomeWay * field.length())) return {};
  found.status = walk.status;
  found.reason = walk.reason;
  return found;
}

}  // namespace catena::haptics
