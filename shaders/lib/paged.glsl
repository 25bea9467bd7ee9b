// SPDX-License-Identifier: MIT
// Sample of a paged volume (render/raycast/paged_volume.h): trilinear value in codes and the cell's gradient, from the page that covers the
// position, of whatever level. Counts the visits of entries of the page table.
layout(binding = 5) uniform utexture3D page_table;
layout(binding = 10) uniform utexture3D sub_bricks;
layout(scalar, binding = 11) uniform Levels { PageLevels pages; };
layout(binding = 12) buffer Visits { uint visits[]; };
#include "shaders/lib/packed_cell.glsl"

#define PAGE_EDGE 64
#define PAGE_BRICKS 8

struct PackedSample {
  float code;
  vec3 gradient;  // codes per finest voxel, of the cell
  uint brick;     // word of the page table
  ivec3 cell;     // cell in the page
  bool valid;
};

int last_entry = -1;  // entry of the last sample

ivec3 unpack_slot(uint word) { return ivec3(word & 127u, word >> 7 & 127u, word >> 14 & 127u); }
uint page_level(uint word) { return word >> 21 & 15u; }
int page_distance(uint word) { return int(word >> 25 & 63u); }

// Returns the entry that contains a position of the domain.
ivec3 entry_of(vec3 p) { return ivec3(clamp(floor(p), frame.grids[0].lo, frame.grids[0].hi - 1.0)) >> 6; }

// Returns the first voxel of the page that an entry refers to, in its level.
vec3 first_of_page(uint level, vec3 entry) {
  return float(PAGE_EDGE) * min(floor(entry / pages.levels[level].entries), pages.levels[level].last);
}

PackedSample sample_packed(vec3 p) {
  const ivec3 entry = entry_of(p);
  PackedSample s;
  s.brick = texelFetch(page_table, entry, 0).r;
  s.cell = ivec3(0);
  if (!is_stored(s.brick)) {
    s.code = float(s.brick & 255u);
    s.gradient = vec3(0.0);
    s.valid = MASKED == 0u || s.code > 0.0;
    return s;
  }
  const ivec3 counts = textureSize(page_table, 0);
  const int index = (entry.z * counts.y + entry.y) * counts.x + entry.x;
  if (index != last_entry) {
    last_entry = index;
    atomicAdd(visits[index], 1u + uint(255.0 * seen_transmittance));
  }
  const uint level = page_level(s.brick);
  const vec3 scale = pages.levels[level].scale;
  const vec3 at_page = clamp(scale * p + pages.levels[level].offset - first_of_page(level, vec3(entry)), vec3(0.0), vec3(PAGE_EDGE));
  const vec3 base = min(floor(at_page), vec3(PAGE_EDGE - 1));
  const vec3 f = at_page - base;
  s.cell = ivec3(base);
  const ivec3 at = unpack_slot(s.brick) * ivec3(PAGE_EDGE, PAGE_EDGE + 1, PAGE_EDGE + 1) + s.cell;
  vec4 near, far;
  read_cell(at, near, far);
  s.valid = is_valid_cell(near, far);
  vec3 gradient;
  s.code = interpolate_cell(near, far, f, gradient);
  s.gradient = scale * gradient;
  return s;
}

// Returns how many finest voxels a voxel at a sample is wide.
float voxel_width(PackedSample s) { return is_stored(s.brick) ? pages.levels[page_level(s.brick)].step : 1.0; }

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

// Returns the depth from a sample to the ray's exit from the homogeneous part around it; 0: the values vary there. A part lies within the
// page table's homogeneous entries, or within an entry's sub-bricks.
float homogeneous_exit(PackedSample s, vec3 p, vec3 direction, vec3 inverse, vec3 is_forward_axis) {
  const vec3 entry = vec3(entry_of(p));
  const bool stored = is_stored(s.brick);
  const float d = stored ? 1.0 : float(page_distance(s.brick));
  const vec3 way = (mix(entry + 1.0 - d, entry + d, is_forward_axis) * float(PAGE_EDGE) - p) * inverse;
  float leave = d > 0.0 ? min(min(way.x, way.y), way.z) : 0.0;
  if (stored) {
    const uint level = page_level(s.brick);
    const ivec3 brick = s.cell >> 3;
    const float b = float(texelFetch(sub_bricks, unpack_slot(s.brick) * PAGE_BRICKS + brick, 0).r);
    const vec3 scale = pages.levels[level].scale, at_page = scale * p + pages.levels[level].offset - first_of_page(level, entry);
    const vec3 sub_way = (mix(vec3(brick) + 1.0 - b, vec3(brick) + b, is_forward_axis) * 8.0 - at_page) * (inverse / scale);
    leave = b > 0.0 ? min(leave, min(min(sub_way.x, sub_way.y), sub_way.z)) : 0.0;
  }
  return leave;
}
