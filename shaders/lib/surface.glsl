// SPDX-License-Identifier: MIT
// First crossing of a level along a ray in a resident grid, by the cells that contain the level.
#include "shaders/lib/surface_cell.glsl"

void level_corners(int i, ivec3 cell, out vec4 lo, out vec4 hi) {
  cell_corners(i, cell, lo, hi);
  lo -= frame.grids[i].level;
  hi -= frame.grids[i].level;
}

#ifdef SURFACE_CELLS
layout(binding = 1) uniform utexture3D cell_map;
uint block_word(int i, ivec3 cell) {
  if (grid_is_cubic(i)) return brick_word(i, cell >> 1);  // the map of a cubic grid is the map of its cells
  return texelFetch(cell_map, cell >> 1, 0).r;
}
#else
const uint HAS_CELLS = 0;
uint block_word(int i, ivec3 cell) { return brick_word(i, cell >> 1); }
#endif

// Advances to the next cell that contains the level, by the cell map (render/residency/cell_map.h).
bool next_cell_in_map(int i, inout CellTraversal traversal, FlippedRay flipped, float to) {
  bool found = false;
  while (!found && traversal.t < to) {
    const ivec3 cell = traversal.cell ^ flipped.turned, odd = cell & 1;
    const uint block = block_word(i, cell);
    found = (block >> (odd.x + 2 * odd.y + 4 * odd.z) & 1u) != 0u;
    if (!found) {
      // skips the bricks without such cells, else the block without, else the cell
      const int distance = int(block >> 8);
      const int block_mask = distance > 0 ? 3 : (block & 255u) == 0u ? 1 : 0;
      advance_past(traversal, flipped, (traversal.cell | block_mask) + (distance > 0 ? 4 * distance - 3 : 1));
    }
  }
  return found;
}

// Advances to the next cell that contains the level, by the brick map and the cells' corners.
bool next_cell_by_corners(int i, inout CellTraversal traversal, FlippedRay flipped, float to) {
  bool found = false;
  while (!found && traversal.t < to) {
    const ivec3 cell = traversal.cell ^ flipped.turned;
    const int distance = empty_distance(brick_word(i, cell >> 3));
    if (distance == 0) {
      vec4 lo, hi;
      level_corners(i, cell, lo, hi);
      found = holds_level(lo, hi) && cell_is_valid(i, cell);
    }
    if (!found) advance_past(traversal, flipped, distance > 0 ? (traversal.cell | 7) + (8 * distance - 7) : traversal.cell + 1);
  }
  return found;
}

#ifndef NO_CUBIC
#include "shaders/lib/cubic_surface.glsl"
#endif

// Returns the first depth in [from, to] at which the ray crosses the level of grid i; NO_DEPTH: none. The inner loop advances to the next
// cell with corners on both sides, the outer one brackets a root of its cubic, and the root is solved after the loops: a driver that
// executes both sides of every branch then does not execute a later stage inside an earlier one.
float first_crossing(int i, LocalRay ray, float from, float to) {
  const FlippedRay flipped = make_flipped_ray(ray, ivec3(frame.grids[i].lo), ivec3(frame.grids[i].hi));
  CellTraversal traversal = CellTraversal(cell_of(i, ray.origin + from * ray.direction) ^ flipped.turned, from, bvec3(false));
#ifndef NO_CUBIC
  if (grid_is_cubic(i)) return first_cubic_crossing(i, traversal, flipped, to);
#endif
  bool found = false;
  vec4 cubic = vec4(0.0);
  Bracket bracket = Bracket(0.0, 0.0, 0.0, 1.0);
  vec2 depths = vec2(from);
  while (!found && traversal.t < to) {
    if (HAS_CELLS != 0u ? next_cell_in_map(i, traversal, flipped, to) : next_cell_by_corners(i, traversal, flipped, to)) {
      vec4 lo, hi;
      level_corners(i, traversal.cell ^ flipped.turned, lo, hi);
      const RaySegment segment = segment_in_cell(traversal, flipped, to);
      cubic = cell_cubic(lo, hi, segment.a, segment.b);
      found = first_bracket(cubic, bracket);
      depths = vec2(segment.from, segment.to);
      advance_past(traversal, flipped, traversal.cell + 1);
    }
  }
  return found ? mix(depths.x, depths.y, find_root(cubic, bracket)) : NO_DEPTH;
}
