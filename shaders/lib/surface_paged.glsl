// SPDX-License-Identifier: MIT
// First crossing of a level along a ray in a paged volume, page by page. Pages of different levels do not meet: where the value is on one
// side of the level at the end of a page, and on the other side at the beginning of the next, the surface is there. `level`: in codes.
#include "shaders/lib/surface_cell.glsl"
#include "shaders/lib/page_traversal.glsl"
#define UNKNOWN NO_DEPTH

// Crossing in a page: the cubic along a segment of the ray, a bracket of its root, and the depths of the segment's ends.
struct PageCrossing {
  vec4 cubic;
  Bracket bracket;
  vec2 depths;
};

// Finds the first crossing in the page of an entry.
bool find_crossing(EntryPart part, float level, out PageCrossing crossing) {
  const FlippedRay flipped = make_flipped_ray(part.ray, ivec3(0), ivec3(PAGE_EDGE));
  const ivec3 slot = unpack_slot(part.word);
  CellTraversal traversal = begin_page(part, flipped);
  bool found = false;
  while (!found && is_inside(traversal, flipped, part.to)) {
    const ivec3 cell = traversal.cell ^ flipped.turned;
    const int distance = int(texelFetch(sub_bricks, slot * PAGE_BRICKS + (cell >> 3), 0).r);
    if (distance > 0) {
      advance_past(traversal, flipped, (traversal.cell | 7) + (8 * distance - 7));
    } else {
      vec4 near, far;
      read_cell(slot * PAGE_TEXELS + cell, near, far);
      if (is_valid_cell(near, far) && holds_level(near - level, far - level)) {
        const RaySegment segment = segment_in_cell(traversal, flipped, part.to);
        crossing.cubic = cell_cubic(near - level, far - level, segment.a, segment.b);
        crossing.depths = vec2(segment.from, segment.to);
        found = first_bracket(crossing.cubic, crossing.bracket);
      }
      advance_past(traversal, flipped, traversal.cell + 1);
    }
  }
  return found;
}

// Returns the value minus the level at a depth of an entry's part of the ray; UNKNOWN where it is not valid.
float side_at(EntryPart part, float t, float level) {
  if (!is_stored(part.word)) return MASKED == 0u ? look_code(part.word) - level : UNKNOWN;
  const PackedSample s = sample_page(part.word, part.ray.origin + t * part.ray.direction);
  return s.valid ? s.code - level : UNKNOWN;
}

// Returns the first depth in [from, to] at which the ray crosses the level; NO_DEPTH: none.
float first_crossing(LocalRay ray, float from, float to, float level) {
  const FlippedRay flipped = make_flipped_ray(ray, ivec3(frame.grids[0].lo), ivec3(frame.grids[0].hi));
  CellTraversal traversal = begin_traversal(ray, flipped, from);
  PageCrossing crossing = PageCrossing(vec4(0.0), Bracket(0.0, 0.0, 0.0, 1.0), vec2(0.0));
  bool found = false;
  float behind = UNKNOWN, between = NO_DEPTH;  // value minus level at the end of the page before; depth of a crossing between pages
  while (!found && is_inside(traversal, flipped, to)) {
    const EntryPart part = enter_entry(ray, traversal, flipped, to);
    const float here = side_at(part, part.from, level);
    if (here != UNKNOWN && behind != UNKNOWN && (here >= 0.0) != (behind >= 0.0)) {
      found = true;
      between = part.from;
    }
    behind = here;
    if (!found && is_stored(part.word)) {
      found = find_crossing(part, level, crossing);
      behind = side_at(part, part.to, level);
    }
    leave_entry(part, traversal, flipped);
  }
  if (!found) return NO_DEPTH;
  return between < NO_DEPTH ? between : mix(crossing.depths.x, crossing.depths.y, find_root(crossing.cubic, crossing.bracket));
}
