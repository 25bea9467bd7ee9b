// The cell of a packed volume (render/mirror/packed_volume.h) around a position: value in codes, trilinear, and its gradient.
struct PackedSample {
  float code;
  vec3 gradient;  // codes a voxel, of the cell
};

vec4 four_codes(uint word) { return vec4(word & 255u, word >> 8 & 255u, word >> 16 & 255u, word >> 24); }

PackedSample sample_packed(vec3 p) {
  const vec3 base = clamp(floor(p), vec3(0.0), frame.grids[0].hi - 1.0);
  const vec3 f = p - base;
  const ivec3 cell = ivec3(base);
  const vec4 near = four_codes(texelFetch(packed_words, cell, 0).r);
  const vec4 along = four_codes(texelFetch(packed_words, cell + ivec3(0, 0, 1), 0).r) - near;
  const vec4 at_z = near + along * f.z;                // (0,0) (1,0) (0,1) (1,1)
  const vec2 along_y = at_z.zw - at_z.xy;              // at x = 0, 1
  const vec2 at_y = at_z.xy + along_y * f.y;
  const vec2 z_at_y = along.xy + (along.zw - along.xy) * f.y;
  PackedSample s;
  s.gradient = vec3(at_y.y - at_y.x, mix(along_y.x, along_y.y, f.x), mix(z_at_y.x, z_at_y.y, f.x));
  s.code = at_y.x + s.gradient.x * f.x;
  return s;
}
