// SPDX-License-Identifier: MIT
// Sample of a paged volume: trilinear value in codes and the cell's gradient, from the page that covers the position, of whatever level.
#include "shaders/lib/packed_cell.glsl"
#include "shaders/lib/page_table.glsl"

struct PackedSample {
  float code;
  vec3 gradient;  // codes per finest voxel, of the cell
  PagePlace place;
  bool valid;
};

// Returns the code of a homogeneous entry.
float look_code(uint word) { return float(word & 65535u); }

PackedSample sample_packed(vec3 p) {
  PackedSample s;
  s.place = find_place(p);
  if (!is_stored(s.place.word)) {
    s.code = look_code(s.place.word);
    s.gradient = vec3(0.0);
    s.valid = MASKED == 0u || s.code > 0.0;
    return s;
  }
  const vec3 cell = cell_of(s.place.at);
  vec4 near, far;
  read_cell(unpack_slot(s.place.word) * PAGE_TEXELS + ivec3(cell), near, far);
  s.valid = is_valid_cell(near, far);
  s.code = interpolate_cell(near, far, s.place.at - cell, s.gradient);
  s.gradient *= s.place.scale;
  return s;
}

float voxel_width(PackedSample s) { return s.place.width; }

// Returns the central difference of codes over a voxel of the page's level on either side, codes per finest voxel. Ends are clamped to the
// domain; an end in an invalid cell is replaced by the center.
vec3 smooth_gradient(vec3 p, PackedSample s) {
  const float width = voxel_width(s);
  vec3 gradient;
  for (int axis = 0; axis < 3; ++axis) {
    vec3 step = vec3(0.0);
    step[axis] = width;
    vec3 a = clamp(p - step, frame.grids[0].lo, frame.grids[0].hi), b = clamp(p + step, frame.grids[0].lo, frame.grids[0].hi);
    PackedSample low = sample_packed(a), high = sample_packed(b);
    if (MASKED != 0u && !low.valid) { low = s; a = p; }
    if (MASKED != 0u && !high.valid) { high = s; b = p; }
    gradient[axis] = (high.code - low.code) / max(dot(b - a, vec3(1.0)), 1e-6);
  }
  return gradient;
}

float homogeneous_exit(PackedSample s, vec3 p, vec3 inverse, vec3 is_forward_axis) {
  return page_exit(s.place, p, inverse, is_forward_axis);
}
