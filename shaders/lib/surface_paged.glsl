// SPDX-License-Identifier: MIT
// First crossing of a level along a ray in a paged volume. The side of the level is followed from cell to cell: where it is another one at
// the beginning of a cell than at the end of the cell before, the surface is between them. So there are no holes where values round
// differently, nor where pages of different levels, whose values differ, meet. `level`: in codes.
#include "shaders/lib/surface_cell.glsl"
#include "shaders/lib/page_traversal.glsl"
#define UNKNOWN_SIDE 0

// Crossing: the cubic along a segment of the ray, a bracket of its root, and the depths of the segment's ends.
struct PageCrossing {
  vec4 cubic;
  Bracket bracket;
  vec2 depths;
};

int side_of(float value) { return value >= 0.0 ? 1 : -1; }
int side_of_code(float code, float level) { return MASKED != 0u && code == 0.0 ? UNKNOWN_SIDE : side_of(code - level); }

// Returns whether the side changes between two cells, at depth t; the crossing is there then.
bool side_changes(int before, int after, float t, inout PageCrossing crossing) {
  const bool changes = before != UNKNOWN_SIDE && after != UNKNOWN_SIDE && before != after;
  if (changes) crossing = PageCrossing(vec4(0.0), Bracket(0.0, 0.0, 0.0, 1.0), vec2(t));
  return changes;
}

// Finds the first crossing in the page of an entry. `side`: at the end of the part before on input, of this part on output.
bool find_crossing(EntryPart part, float level, inout int side, inout PageCrossing crossing) {
  const FlippedRay flipped = make_flipped_ray(part.ray, ivec3(0), ivec3(PAGE_EDGE));
  const ivec3 slot = unpack_slot(part.word);
  CellTraversal traversal = begin_page(part, flipped);
  bool found = false;
  while (!found && is_inside(traversal, flipped, part.to)) {
    const ivec3 cell = traversal.cell ^ flipped.turned;
    const int distance = int(texelFetch(sub_bricks, slot * PAGE_BRICKS + (cell >> 3), 0).r);
    if (distance > 0) {
      const int here = side_of_code(float(slot_word(slot * PAGE_TEXELS + cell)), level);
      found = side_changes(side, here, traversal.t, crossing);
      side = here;
      advance_past(traversal, flipped, (traversal.cell | 7) + (8 * distance - 7));
    } else {
      vec4 near, far;
      read_cell(slot * PAGE_TEXELS + cell, near, far);
      const bool valid = is_valid_cell(near, far);
      near -= level;
      far -= level;
      int begin = valid ? side_of(near.x) : UNKNOWN_SIDE, end = begin;
      if (valid && holds_level(near, far)) {
        const RaySegment segment = segment_in_cell(traversal, flipped, part.to);
        crossing.cubic = cell_cubic(near, far, segment.a, segment.b);
        crossing.depths = vec2(segment.from, segment.to);
        found = first_bracket(crossing.cubic, crossing.bracket);
        begin = side_of(crossing.cubic.x);
        end = side_of(crossing.cubic.w);
      }
      if (side_changes(side, begin, traversal.t, crossing)) found = true;
      side = end;
      advance_past(traversal, flipped, traversal.cell + 1);
    }
  }
  return found;
}

// Returns the first depth in [from, to] at which the ray crosses the level; NO_DEPTH: none.
float first_crossing(LocalRay ray, float from, float to, float level) {
  const FlippedRay flipped = make_flipped_ray(ray, ivec3(frame.grids[0].lo), ivec3(frame.grids[0].hi));
  CellTraversal traversal = begin_traversal(ray, flipped, from);
  PageCrossing crossing = PageCrossing(vec4(0.0), Bracket(0.0, 0.0, 0.0, 1.0), vec2(0.0));
  bool found = false;
  int side = UNKNOWN_SIDE;
  while (!found && is_inside(traversal, flipped, to)) {
    const EntryPart part = enter_entry(ray, traversal, flipped, to);
    if (is_stored(part.word)) {
      found = find_crossing(part, level, side, crossing);
    } else {
      const int here = side_of_code(look_code(part.word), level);
      found = side_changes(side, here, part.from, crossing);
      side = here;
    }
    leave_entry(part, traversal, flipped);
  }
  return found ? mix(crossing.depths.x, crossing.depths.y, find_root(crossing.cubic, crossing.bracket)) : NO_DEPTH;
}
