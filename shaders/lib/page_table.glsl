// SPDX-License-Identifier: MIT
// Page table of a paged volume (render/raycast/paged_volume.h): entries, levels, sub-bricks, and the visits of entries, which it counts.
layout(binding = 5) uniform utexture3D page_table;
layout(binding = 10) uniform utexture3D sub_bricks;
layout(scalar, binding = 11) uniform Levels { PageLevels pages; };
layout(binding = 12) buffer Visits { uint visits[]; };
#define PAGE_EDGE 64
#define PAGE_BRICKS 8
#ifdef HAS_NUMBERS
#define PAGE_TEXELS ivec3(PAGE_EDGE + 1)
#else
#define PAGE_TEXELS ivec3(PAGE_EDGE, PAGE_EDGE + 1, PAGE_EDGE + 1)
#endif

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

// Counts a visit of an entry.
void count_visit(ivec3 entry) {
  const ivec3 counts = textureSize(page_table, 0);
  const int index = (entry.z * counts.y + entry.y) * counts.x + entry.x;
  if (index != last_entry) {
    last_entry = index;
    atomicAdd(visits[index], 1u + uint(255.0 * seen_transmittance));
  }
}

// Returns how many finest voxels a voxel of an entry's page is wide.
float page_voxel_width(uint word) { return is_stored(word) ? pages.levels[page_level(word)].step : 1.0; }

// Returns the depth from a position to the ray's exit from the homogeneous part around it; 0: the values vary there. A part lies within the
// page table's homogeneous entries, or within an entry's sub-bricks. `word`, `cell`: of the position's entry, and its cell in the page.
float page_exit(uint word, ivec3 cell, vec3 p, vec3 inverse, vec3 is_forward_axis) {
  const vec3 entry = vec3(entry_of(p));
  const bool stored = is_stored(word);
  const float d = stored ? 1.0 : float(page_distance(word));
  const vec3 way = (mix(entry + 1.0 - d, entry + d, is_forward_axis) * float(PAGE_EDGE) - p) * inverse;
  float leave = d > 0.0 ? min(min(way.x, way.y), way.z) : 0.0;
  if (stored) {
    const uint level = page_level(word);
    const ivec3 brick = cell >> 3;
    const float b = float(texelFetch(sub_bricks, unpack_slot(word) * PAGE_BRICKS + brick, 0).r);
    const vec3 scale = pages.levels[level].scale, at_page = scale * p + pages.levels[level].offset - first_of_page(level, entry);
    const vec3 sub_way = (mix(vec3(brick) + 1.0 - b, vec3(brick) + b, is_forward_axis) * 8.0 - at_page) * (inverse / scale);
    leave = b > 0.0 ? min(leave, min(min(sub_way.x, sub_way.y), sub_way.z)) : 0.0;
  }
  return leave;
}
