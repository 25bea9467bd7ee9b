// SPDX-License-Identifier: MIT
// Page table of a paged volume (render/raycast/paged_volume.h): entries, levels, sub-bricks, and the visits of entries, which it counts.
layout(binding = 5) uniform utexture3D page_table;
layout(binding = 10) uniform utexture3D sub_bricks;
layout(scalar, binding = 11) uniform Levels { PageLevels pages; };
layout(binding = 12) buffer Visits { uint visits[]; };
layout(constant_id = 5) const uint HALVES_VOXELS = 0;  // PagedVolume::halves_voxels(): the levels' scale and offset follow from their shifts
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

// Returns s of a level: a page covers 2^s entries along each axis.
ivec3 page_shift(uint level) {
  const uint bits = pages.levels[level].last_z_shifts;
  return ivec3(bits >> 16 & 31u, bits >> 21 & 31u, bits >> 26 & 31u);
}

// Returns the first voxel of the page that an entry refers to, in its level.
vec3 first_of_page(uint level, ivec3 entry) {
  const uint xy = pages.levels[level].last_xy, z = pages.levels[level].last_z_shifts;
  return vec3(min(entry >> page_shift(level), ivec3(xy & 65535u, xy >> 16, z & 65535u)) * PAGE_EDGE);
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

// Place of a position in the page that covers it.
struct PagePlace {
  uint word;       // of the page table; the rest is undefined if the entry is homogeneous, except `width`
  ivec3 entry;
  vec3 at, scale;  // position in voxels of the page, and voxels per finest voxel
  float width;     // finest voxels per voxel, along the axis with the fewest
};

// Returns the place of a position, and counts its visit.
PagePlace find_place(vec3 p) {
  PagePlace place;
  place.entry = entry_of(p);
  place.word = texelFetch(page_table, place.entry, 0).r;
  place.width = 1.0;
  if (is_stored(place.word)) {
    count_visit(place.entry);
    const uint level = page_level(place.word);
    const ivec3 shift = page_shift(level);
    place.width = float(1 << min(min(shift.x, shift.y), shift.z));
    const vec3 part = intBitsToFloat((127 - shift) << 23);  // 2^-shift
    place.scale = HALVES_VOXELS != 0u ? part : pages.levels[level].scale;
    const vec3 offset = HALVES_VOXELS != 0u ? 0.5 * part - 0.5 : pages.levels[level].offset;
    place.at = clamp(place.scale * p + offset - first_of_page(level, place.entry), vec3(0.0), vec3(PAGE_EDGE));
  }
  return place;
}

// Returns the cell of a position in a page.
vec3 cell_of(vec3 at_page) { return min(floor(at_page), vec3(PAGE_EDGE - 1)); }

// Returns the depth from a position to the ray's exit from the homogeneous part around it; 0: the values vary there. A part lies within the
// page table's homogeneous entries, or within an entry's sub-bricks.
float page_exit(PagePlace place, vec3 p, vec3 inverse, vec3 is_forward_axis) {
  const vec3 entry = vec3(place.entry);
  const bool stored = is_stored(place.word);
  const float d = stored ? 1.0 : float(page_distance(place.word));
  const vec3 way = (mix(entry + 1.0 - d, entry + d, is_forward_axis) * float(PAGE_EDGE) - p) * inverse;
  float leave = d > 0.0 ? min(min(way.x, way.y), way.z) : 0.0;
  if (stored) {
    const ivec3 brick = ivec3(cell_of(place.at)) >> 3;
    const float b = float(texelFetch(sub_bricks, unpack_slot(place.word) * PAGE_BRICKS + brick, 0).r);
    const vec3 sub_way = (mix(vec3(brick) + 1.0 - b, vec3(brick) + b, is_forward_axis) * 8.0 - place.at) * (inverse / place.scale);
    leave = b > 0.0 ? min(leave, min(min(sub_way.x, sub_way.y), sub_way.z)) : 0.0;
  }
  return leave;
}
