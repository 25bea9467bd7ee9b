// SPDX-License-Identifier: MIT
// Sample of a paged volume: trilinear value in codes and the cell's gradient, from the page that covers the position, of whatever level.
#include "shaders/lib/packed_cell.glsl"
#include "shaders/lib/page_table.glsl"

struct PackedSample {
  float code;
  vec3 gradient;  // codes per finest voxel, of the cell
  uint brick;     // word of the page table
  ivec3 cell;     // cell in the page
  bool valid;
};

// Returns the code of a homogeneous entry.
float look_code(uint word) { return float(word & 65535u); }

// Returns the sample at a position in the page that an entry refers to, without its gradient's scale.
PackedSample sample_page(uint word, vec3 at_page) {
  PackedSample s;
  s.brick = word;
  at_page = clamp(at_page, vec3(0.0), vec3(PAGE_EDGE));
  const vec3 base = min(floor(at_page), vec3(PAGE_EDGE - 1));
  s.cell = ivec3(base);
  vec4 near, far;
  read_cell(unpack_slot(word) * PAGE_TEXELS + s.cell, near, far);
  s.valid = is_valid_cell(near, far);
  s.code = interpolate_cell(near, far, at_page - base, s.gradient);
  return s;
}

PackedSample sample_packed(vec3 p) {
  const ivec3 entry = entry_of(p);
  const uint word = texelFetch(page_table, entry, 0).r;
  if (!is_stored(word)) {
    const float code = look_code(word);
    return PackedSample(code, vec3(0.0), word, ivec3(0), MASKED == 0u || code > 0.0);
  }
  count_visit(entry);
  const uint level = page_level(word);
  const vec3 scale = pages.levels[level].scale;
  PackedSample s = sample_page(word, scale * p + pages.levels[level].offset - first_of_page(level, vec3(entry)));
  s.gradient *= scale;
  return s;
}

float voxel_width(PackedSample s) { return page_voxel_width(s.brick); }

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
  return page_exit(s.brick, s.cell, p, inverse, is_forward_axis);
}
