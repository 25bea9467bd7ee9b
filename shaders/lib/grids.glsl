// SPDX-License-Identifier: MIT
// Grids as textures: dense or brick atlas (render/residency), with masks and brick maps. GRID_COUNT of them are bound. An includer that
// defines NO_CUBIC does not support cubic grids; code that is never executed still costs compile time. The switches replace indexing of an
// array of textures, which lavapipe does not support; they are resolved at compile time for a constant index.
#define BRICK_SIZE 8
#define PADDED_BRICK_SIZE 9

layout(scalar, binding = 0) uniform Frame { FrameData frame; };
layout(binding = 3) uniform sampler3D values_0;
layout(binding = 11) uniform utexture3D map_0;
layout(binding = 19) uniform utexture3D mask_0;
#if GRID_COUNT > 1  // GRID_COUNT is 2, 6 or 8
layout(binding = 4) uniform sampler3D values_1;
layout(binding = 12) uniform utexture3D map_1;
layout(binding = 20) uniform utexture3D mask_1;
#endif
#if GRID_COUNT > 2
layout(binding = 5) uniform sampler3D values_2;
layout(binding = 6) uniform sampler3D values_3;
layout(binding = 7) uniform sampler3D values_4;
layout(binding = 8) uniform sampler3D values_5;
layout(binding = 13) uniform utexture3D map_2;
layout(binding = 14) uniform utexture3D map_3;
layout(binding = 15) uniform utexture3D map_4;
layout(binding = 16) uniform utexture3D map_5;
layout(binding = 21) uniform utexture3D mask_2;
layout(binding = 22) uniform utexture3D mask_3;
layout(binding = 23) uniform utexture3D mask_4;
layout(binding = 24) uniform utexture3D mask_5;
#if GRID_COUNT > 6
layout(binding = 9) uniform sampler3D values_6;
layout(binding = 10) uniform sampler3D values_7;
layout(binding = 17) uniform utexture3D map_6;
layout(binding = 18) uniform utexture3D map_7;
layout(binding = 25) uniform utexture3D mask_6;
layout(binding = 26) uniform utexture3D mask_7;
#define SWITCH_GRID(i, CALL) \
  switch (i) {               \
    case 0: return CALL(0);  \
    case 1: return CALL(1);  \
    case 2: return CALL(2);  \
    case 3: return CALL(3);  \
    case 4: return CALL(4);  \
    case 5: return CALL(5);  \
    case 6: return CALL(6);  \
    default: return CALL(7); \
  }
#else
#define SWITCH_GRID(i, CALL) \
  switch (i) {               \
    case 0: return CALL(0);  \
    case 1: return CALL(1);  \
    case 2: return CALL(2);  \
    case 3: return CALL(3);  \
    case 4: return CALL(4);  \
    default: return CALL(5); \
  }
#endif
#elif GRID_COUNT > 1
#define SWITCH_GRID(i, CALL) \
  switch (i) {               \
    case 0: return CALL(0);  \
    default: return CALL(1); \
  }
#else
#define SWITCH_GRID(i, CALL) return CALL(0);
#endif

// three bits per grid, then two per volume (grids 0..3)
layout(constant_id = 0) const uint GRID_FLAGS = 0;
bool grid_is_atlas(int i) { return (GRID_FLAGS >> (3 * i) & 1u) != 0u; }
bool grid_is_masked(int i) { return (GRID_FLAGS >> (3 * i) & 2u) != 0u; }
bool grid_is_cubic(int i) { return (GRID_FLAGS >> (3 * i) & 4u) != 0u; }
bool volume_is_shaded(int i) { return (GRID_FLAGS >> (24 + 2 * i) & 1u) != 0u; }
bool volume_skips(int i) { return (GRID_FLAGS >> (24 + 2 * i) & 2u) != 0u; }

float filtered_texel(int i, vec3 uvw) {
#define FILTERED(n) textureLod(values_##n, uvw, 0.0).r
  SWITCH_GRID(i, FILTERED)
}
float texel(int i, ivec3 at) {
#define TEXEL(n) texelFetch(values_##n, at, 0).r
  SWITCH_GRID(i, TEXEL)
}
uint brick_word(int i, ivec3 brick) {
#define WORD(n) texelFetch(map_##n, brick, 0).r
  SWITCH_GRID(i, WORD)
}
uint mask_texel(int i, ivec3 at) {
#define MASK(n) texelFetch(mask_##n, at, 0).r
  SWITCH_GRID(i, MASK)
}

ivec3 unpack_slot(uint word) { return ivec3(word & 255u, word >> 8 & 255u, word >> 16 & 255u); }
int empty_distance(uint word) { return int(word >> 24); }
// words of a volume's map (render/residency/brick_map.h)
int skip_distance(uint word) { return int(word >> 24 & 127u); }
bool is_homogeneous(uint word) { return word >> 31 != 0u; }

// Returns the cell that contains a local position of the domain.
ivec3 cell_of(int i, vec3 p) { return ivec3(clamp(floor(p), frame.grids[i].lo, frame.grids[i].hi - 1.0)); }

#ifndef NO_CUBIC
#include "shaders/lib/cubic.glsl"
#endif

// Returns the texel value at a local position of the domain: trilinear, cubic, or of the nearest voxel center.
float sample_texel(int i, vec3 p) {
#ifndef NO_CUBIC
  if (grid_is_cubic(i)) return cubic_value(fetch_cubic_at(i, p));
#endif
  float t;
  p = mix(p, floor(p + 0.5), frame.grids[i].nearest);
  if (grid_is_atlas(i)) {
    const ivec3 brick = cell_of(i, p) >> 3;
    const ivec3 slot = unpack_slot(brick_word(i, brick));
    t = filtered_texel(i, (vec3(slot * PADDED_BRICK_SIZE) + (p - vec3(brick * BRICK_SIZE)) + 0.5) * frame.grids[i].texel);
  } else {
    t = filtered_texel(i, (p + 0.5) * frame.grids[i].texel);
  }
  return t;
}

float sample_value(int i, vec3 p) { return frame.grids[i].value_offset + frame.grids[i].value_scale * sample_texel(i, p); }

bool cell_is_valid(int i, ivec3 cell) {
  if (!grid_is_masked(i)) return true;
  if (grid_is_atlas(i)) return mask_texel(i, unpack_slot(brick_word(i, cell >> 3)) * BRICK_SIZE + (cell & 7)) != 0u;
  return mask_texel(i, cell) != 0u;
}

// Reads the corners i + 2 j + 4 k of a cell: lo = (000, 100, 010, 110), hi = the corners one plane up.
void cell_corners(int i, ivec3 cell, out vec4 lo, out vec4 hi) {
  ivec3 at = cell;
  if (grid_is_atlas(i)) at = unpack_slot(brick_word(i, cell >> 3)) * PADDED_BRICK_SIZE + (cell & 7);
  lo = vec4(texel(i, at), texel(i, at + ivec3(1, 0, 0)), texel(i, at + ivec3(0, 1, 0)), texel(i, at + ivec3(1, 1, 0)));
  hi = vec4(texel(i, at + ivec3(0, 0, 1)), texel(i, at + ivec3(1, 0, 1)), texel(i, at + ivec3(0, 1, 1)), texel(i, at + ivec3(1, 1, 1)));
  lo = frame.grids[i].value_offset + frame.grids[i].value_scale * lo;
  hi = frame.grids[i].value_offset + frame.grids[i].value_scale * hi;
}

// Returns the weights of the upper corners along the axes; 0 or 1 for nearest interpolation.
vec3 corner_weights(int i, vec3 f) { return mix(f, step(0.5, f), frame.grids[i].nearest); }

// Returns the central difference of texels along one axis. Both ends are clamped to the domain; an end in an invalid cell is replaced by
// the center. Differences within the rounding error are zero, because constant regions would be shaded randomly otherwise.
float central_difference(int i, vec3 p, vec3 step) {
  vec3 a = clamp(p - step, frame.grids[i].lo, frame.grids[i].hi), b = clamp(p + step, frame.grids[i].lo, frame.grids[i].hi);
  if (grid_is_masked(i)) {
    if (!cell_is_valid(i, cell_of(i, a))) a = p;
    if (!cell_is_valid(i, cell_of(i, b))) b = p;
  }
  const float moved = dot(b - a, vec3(1.0));
  const float low = sample_texel(i, a), high = sample_texel(i, b);
  return abs(high - low) > 1e-6 * (abs(low) + abs(high)) ? (high - low) / moved : 0.0;
}

// Returns the gradient in world axes, up to the texels' positive scale: central differences over one voxel on either side, or the analytic
// gradient of a cubic grid; 0 for nearest interpolation.
vec3 world_gradient(int i, vec3 p) {
#ifndef NO_CUBIC
  if (grid_is_cubic(i)) {
    vec3 gradient;
    cubic_value(fetch_cubic_at(i, p), gradient);
    return frame.grids[i].world_gradient * gradient;
  }
#endif
  return (1.0 - frame.grids[i].nearest) * frame.grids[i].world_gradient * vec3(central_difference(i, p, vec3(1.0, 0.0, 0.0)), central_difference(i, p, vec3(0.0, 1.0, 0.0)),
                                              central_difference(i, p, vec3(0.0, 0.0, 1.0)));
}
