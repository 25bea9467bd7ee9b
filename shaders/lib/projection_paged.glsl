// SPDX-License-Identifier: MIT
// Extremum or mean of a paged volume's codes along a ray, as in projection.glsl. A texel n of sub_bricks bounds its 8^3 cells: 0: no cell
// is valid; else no signed code is above bound_lo + n bound_per_code; 255: there is no bound.
#include "shaders/lib/cell_traversal.glsl"
#include "shaders/lib/page_traversal.glsl"

float interpolate_cell(vec4 lo, vec4 hi, vec3 position) {
  vec3 gradient;
  return interpolate_cell(lo, hi, position, gradient);
}
#include "shaders/lib/extremum.glsl"

float bound_of(uint n) { return n == 255u ? NO_DEPTH : frame.grids[0].bound_lo + float(n) * frame.grids[0].bound_per_code; }

// Returns the maximum of `best` and of the signed codes in the page of an entry.
float max_in_page(EntryPart part, float best) {
  const FlippedRay flipped = make_flipped_ray(part.ray, ivec3(0), ivec3(PAGE_EDGE));
  const ivec3 slot = unpack_slot(part.word);
  CellTraversal traversal = begin_page(part, flipped);
  while (is_inside(traversal, flipped, part.to)) {
    const ivec3 cell = traversal.cell ^ flipped.turned;
    const uint bound = texelFetch(sub_bricks, slot * PAGE_BRICKS + (cell >> 3), 0).r;
    if (bound == 0u || bound_of(bound) <= best) {
      advance_past(traversal, flipped, (traversal.cell | 7) + 1);
    } else {
      vec4 near, far;
      read_cell(slot * PAGE_TEXELS + cell, near, far);
      if (is_valid_cell(near, far)) {
        near = vec4(signed_value(near.x), signed_value(near.y), signed_value(near.z), signed_value(near.w));
        far = vec4(signed_value(far.x), signed_value(far.y), signed_value(far.z), signed_value(far.w));
        const vec4 maxima = max(near, far);
        if (max(max(maxima.x, maxima.y), max(maxima.z, maxima.w)) > best) {
          const RaySegment segment = segment_in_cell(traversal, flipped, part.to);
          best = max(best, max_between(near, far, segment.a, segment.b));
        }
      }
      advance_past(traversal, flipped, traversal.cell + 1);
    }
  }
  return best;
}

// Returns the extremum along the ray; NO_DEPTH: no value.
float find_extremum(LocalRay ray, vec2 interval) {
  const FlippedRay flipped = make_flipped_ray(ray, ivec3(frame.grids[0].lo), ivec3(frame.grids[0].hi));
  CellTraversal traversal = begin_traversal(ray, flipped, interval.x);
  float best = -NO_DEPTH;
  while (is_inside(traversal, flipped, interval.y)) {
    const EntryPart part = enter_entry(ray, traversal, flipped, interval.y);
    if (is_stored(part.word)) best = max_in_page(part, best);
    else if (MASKED == 0u || look_code(part.word) > 0.0) best = max(best, signed_value(look_code(part.word)));
    leave_entry(part, traversal, flipped);
  }
  return best > -NO_DEPTH ? signed_value(best) : NO_DEPTH;
}

// Returns whether the code at a position is valid.
bool value_at(vec3 p, out float code) {
  const PackedSample s = sample_packed(p);
  code = s.code;
  return s.valid;
}
