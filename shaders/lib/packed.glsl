// SPDX-License-Identifier: MIT
// Sample of a packed volume: trilinear value in codes, and the cell's gradient. Two layouts:
//   dense (render/residency/packed_volume.h): two words of four codes per cell
//   IS_BRICKED (render/residency/packed_atlas.h): four words of two codes in the brick's slot, or the constant code of the brick
layout(constant_id = 5) const uint IS_BRICKED = 0;

layout(binding = 5) uniform utexture3D homogeneous_map;
layout(binding = 8) uniform sampler3D gradients;  // render/residency/gradient_volume.h
#include "shaders/lib/packed_cell.glsl"

#define SMALL_BRICK_SIZE 4.0

struct PackedSample {
  float code;
  vec3 gradient;  // codes per voxel, of the cell
  uint brick;     // IS_BRICKED: word of the brick map
  bool valid;
};

vec3 unpack_slot(uint word) { return vec3(word & 255u, word >> 8 & 255u, word >> 16 & 255u); }

PackedSample sample_packed(vec3 p) {
  const vec3 base = clamp(floor(p), frame.grids[0].lo, frame.grids[0].hi - 1.0);
  const vec3 f = p - base;
  const ivec3 cell = ivec3(base);
  PackedSample s;
  s.brick = 0u;
  vec4 near, far;  // (0,0) (1,0) (0,1) (1,1) in x and y, at z = 0 and 1
  if (IS_BRICKED != 0u) {
    s.brick = texelFetch(homogeneous_map, cell >> 3, 0).r;
    const bool stored = is_stored(s.brick);
    const ivec3 at = stored ? ivec3(unpack_slot(s.brick)) * ivec3(8, 9, 9) + (cell & 7) : ivec3(0);
    read_cell(at, near, far);
    if (!stored) near = far = vec4(s.brick & 255u);
  } else {
    near = four_codes(slot_word(cell));
    far = four_codes(slot_word(cell + ivec3(0, 0, 1)));
  }
  s.valid = is_valid_cell(near, far);
  s.code = interpolate_cell(near, far, f, s.gradient);
  return s;
}

float voxel_width(PackedSample s) { return 1.0; }

// Returns the precomputed gradient at a position, codes per voxel.
vec3 smooth_gradient(vec3 p, PackedSample s) {
  vec3 uvw = (p + 0.5) / (frame.grids[0].hi + 1.0);
  if (IS_BRICKED != 0u) {
    const vec3 brick = floor(clamp(floor(p), frame.grids[0].lo, frame.grids[0].hi - 1.0) * 0.125);
    const float nodes = ray_grid.gradient_nodes;
    uvw = (nodes * unpack_slot(s.brick) + 0.125 * (nodes - 1.0) * (p - 8.0 * brick) + 0.5) / vec3(textureSize(gradients, 0));
    if (!is_stored(s.brick)) return vec3(0.0);
  }
  return textureLod(gradients, uvw, 0.0).rgb;
}

// Returns the depth from a sample to the ray's exit from the cube of homogeneous bricks around it; 0: the values vary there.
float homogeneous_exit(PackedSample s, vec3 p, vec3 inverse, vec3 is_forward_axis) {
  const float size = IS_BRICKED != 0u ? 8.0 : SMALL_BRICK_SIZE;
  const vec3 brick = min(floor(p * (1.0 / size)), ceil(frame.grids[0].hi * (1.0 / size)) - 1.0);
  const float d = float(IS_BRICKED != 0u ? s.brick >> 24 & 127u : texelFetch(homogeneous_map, ivec3(brick), 0).r);
  const vec3 way = (mix(brick + 1.0 - d, brick + d, is_forward_axis) * size - p) * inverse;
  return d > 0.0 ? min(min(way.x, way.y), way.z) : 0.0;
}
