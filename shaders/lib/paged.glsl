// SPDX-License-Identifier: MIT
// Sample of a paged volume (render/raycast/paged_volume.h): trilinear value in codes and the cell's gradient, from the page that covers the
// position, of whatever level. Counts the visits of entries of the page table.
layout(constant_id = 6) const uint MASKED = 0;  // a cell is valid if none of its codes is 0

layout(binding = 3) uniform utexture3D packed_words;
layout(binding = 5) uniform utexture3D page_table;
layout(binding = 10) uniform utexture3D sub_bricks;
layout(scalar, binding = 11) uniform Levels { PageLevels pages; };
layout(binding = 12) buffer Visits { uint visits[]; };

#define PAGE_EDGE 64
#define PAGE_BRICKS 8

struct PackedSample {
  float code;
  vec3 gradient;  // codes per finest voxel, of the cell
  uint brick;     // word of the page table
  ivec3 cell;     // cell in the page
  bool valid;
};

int last_entry = -1;            // entry of the last sample
float seen_transmittance = 1.0;  // of the ray in front of it

vec4 four_codes(uint word) { return vec4(word & 255u, word >> 8 & 255u, word >> 16 & 255u, word >> 24); }
uint slot_word(ivec3 at) { return texelFetch(packed_words, at, 0).r; }
bool is_stored(uint word) { return word >> 31 == 0u; }
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
  s.valid = true;
  s.cell = ivec3(0);
  if (!is_stored(s.brick)) {
    s.code = float(s.brick & 255u);
    s.gradient = vec3(0.0);
    if (MASKED != 0u) s.valid = s.code > 0.0;
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
  const vec4 near = four_codes(slot_word(at) | slot_word(at + ivec3(0, 1, 0)) << 16);
  const vec4 far = four_codes(slot_word(at + ivec3(0, 0, 1)) | slot_word(at + ivec3(0, 1, 1)) << 16);
  if (MASKED != 0u) s.valid = all(greaterThan(min(near, far), vec4(0.0)));
  const vec4 along = far - near;
  const vec4 at_z = near + along * f.z;
  const vec2 along_y = at_z.zw - at_z.xy;  // at x = 0, 1
  const vec2 at_y = at_z.xy + along_y * f.y;
  const vec2 z_at_y = along.xy + (along.zw - along.xy) * f.y;
  const vec3 gradient = vec3(at_y.y - at_y.x, mix(along_y.x, along_y.y, f.x), mix(z_at_y.x, z_at_y.y, f.x));
  s.code = at_y.x + gradient.x * f.x;
  s.gradient = scale * gradient;
  return s;
}

// Returns the central difference of codes over a voxel of the page's level on either side, codes per finest voxel. Ends are clamped to the
// domain; an end in an invalid cell is replaced by the center.
vec3 central_gradient(vec3 p, PackedSample s) {
  const float width = is_stored(s.brick) ? pages.levels[page_level(s.brick)].step : 1.0;
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

// Returns how many finest voxels a voxel at a sample is wide.
float voxel_width(PackedSample s) { return is_stored(s.brick) ? pages.levels[page_level(s.brick)].step : 1.0; }

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
