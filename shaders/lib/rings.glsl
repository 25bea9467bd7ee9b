// SPDX-License-Identifier: MIT
// Returns the unit vector of octahedral coordinates, two signed normalized 16-bit values.
vec3 unpack_direction(uint packed) {
  const vec2 e = unpackSnorm2x16(packed);
  const float z = 1.0 - abs(e.x) - abs(e.y), fold = max(-z, 0.0);
  return normalize(vec3(e.x - (e.x >= 0.0 ? fold : -fold), e.y - (e.y >= 0.0 ? fold : -fold), z));
}

// Returns the color of a ring.
vec3 ring_color(uint packed) { return vec3(packed & 1023u, packed >> 10 & 1023u, packed >> 20 & 1023u) / float(RING_COLOR_MAX); }
