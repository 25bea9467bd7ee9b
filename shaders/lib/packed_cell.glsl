// SPDX-License-Identifier: MIT
// Cell of a packed volume: the codes of its corners, and their trilinear interpolation. An includer that defines HAS_NUMBERS has pages of
// 16-bit codes (PageFormat::numbers, render/residency/page_loader.h), one per texel, others texels with the codes of two nodes.
layout(constant_id = 6) const uint MASKED = 0;  // a cell is valid if none of its codes is 0

layout(binding = 3) uniform utexture3D packed_words;

vec4 four_codes(uint word) { return vec4(word & 255u, word >> 8 & 255u, word >> 16 & 255u, word >> 24); }
uint slot_word(ivec3 at) { return texelFetch(packed_words, at, 0).r; }
bool is_stored(uint word) { return word >> 31 == 0u; }

// Reads the corners of a cell: (0,0) (1,0) (0,1) (1,1) in x and y, at z = 0 and 1.
#ifdef HAS_NUMBERS
vec4 four_numbers(ivec3 at) {
  return vec4(slot_word(at), slot_word(at + ivec3(1, 0, 0)), slot_word(at + ivec3(0, 1, 0)), slot_word(at + ivec3(1, 1, 0)));
}
void read_cell(ivec3 at, out vec4 near, out vec4 far) {
  near = four_numbers(at);
  far = four_numbers(at + ivec3(0, 0, 1));
}
#else
void read_cell(ivec3 at, out vec4 near, out vec4 far) {
  near = four_codes(slot_word(at) | slot_word(at + ivec3(0, 1, 0)) << 16);
  far = four_codes(slot_word(at + ivec3(0, 0, 1)) | slot_word(at + ivec3(0, 1, 1)) << 16);
}
#endif

bool is_valid_cell(vec4 near, vec4 far) { return MASKED == 0u || all(greaterThan(min(near, far), vec4(0.0))); }

// Returns the trilinear value at f in the cell, and the cell's gradient there, codes per voxel.
float interpolate_cell(vec4 near, vec4 far, vec3 f, out vec3 gradient) {
  const vec4 along = far - near;
  const vec4 at_z = near + along * f.z;
  const vec2 along_y = at_z.zw - at_z.xy;  // at x = 0, 1
  const vec2 at_y = at_z.xy + along_y * f.y;
  const vec2 z_at_y = along.xy + (along.zw - along.xy) * f.y;
  gradient = vec3(at_y.y - at_y.x, mix(along_y.x, along_y.y, f.x), mix(z_at_y.x, z_at_y.y, f.x));
  return at_y.x + gradient.x * f.x;
}
