// SPDX-License-Identifier: MIT
// Sample of a packed volume: trilinear value in codes, and the cell's gradient. Two layouts:
//   dense (render/residency/packed_volume.h): two words of four codes per cell
//   IS_BRICKED (render/residency/packed_atlas.h): four words of two codes in the brick's slot, or the constant code of the brick
layout(constant_id = 5) const uint IS_BRICKED = 0;
layout(constant_id = 6) const uint MASKED = 0;  // a cell is valid if none of its codes is 0

layout(binding = 3) uniform utexture3D packed_words;
layout(binding = 5) uniform utexture3D homogeneous_map;

struct PackedSample {
  float code;
  vec3 gradient;  // codes per voxel, of the cell
  uint brick;     // IS_BRICKED: word of the brick map
  bool valid;
};

vec4 four_codes(uint word) { return vec4(word & 255u, word >> 8 & 255u, word >> 16 & 255u, word >> 24); }

uint slot_word(ivec3 at) { return texelFetch(packed_words, at, 0).r; }

bool is_stored(uint word) { return word >> 31 == 0u; }
vec3 unpack_slot(uint word) { return vec3(word & 255u, word >> 8 & 255u, word >> 16 & 255u); }

PackedSample sample_packed(vec3 p) {
  const vec3 base = clamp(floor(p), frame.grids[0].lo, frame.grids[0].hi - 1.0);
  const vec3 f = p - base;
  const ivec3 cell = ivec3(base);
  PackedSample s;
  s.brick = 0u;
  s.valid = true;
  vec4 near, far;  // (0,0) (1,0) (0,1) (1,1) in x and y, at z = 0 and 1
  if (IS_BRICKED != 0u) {
    s.brick = texelFetch(homogeneous_map, cell >> 3, 0).r;
    const bool stored = is_stored(s.brick);
    const ivec3 at = stored ? ivec3(unpack_slot(s.brick)) * ivec3(8, 9, 9) + (cell & 7) : ivec3(0);
    near = four_codes(slot_word(at) | slot_word(at + ivec3(0, 1, 0)) << 16);
    far = four_codes(slot_word(at + ivec3(0, 0, 1)) | slot_word(at + ivec3(0, 1, 1)) << 16);
    if (!stored) near = far = vec4(s.brick & 255u);
  } else {
    near = four_codes(slot_word(cell));
    far = four_codes(slot_word(cell + ivec3(0, 0, 1)));
  }
  if (MASKED != 0u) s.valid = all(greaterThan(min(near, far), vec4(0.0)));
  const vec4 along = far - near;
  const vec4 at_z = near + along * f.z;
  const vec2 along_y = at_z.zw - at_z.xy;              // at x = 0, 1
  const vec2 at_y = at_z.xy + along_y * f.y;
  const vec2 z_at_y = along.xy + (along.zw - along.xy) * f.y;
  s.gradient = vec3(at_y.y - at_y.x, mix(along_y.x, along_y.y, f.x), mix(z_at_y.x, z_at_y.y, f.x));
  s.code = at_y.x + s.gradient.x * f.x;
  return s;
}
