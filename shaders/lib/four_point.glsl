// SPDX-License-Identifier: MIT
// Returns the midpoint between b and c by the four-point cubic.
vec4 interpolate_midpoint(vec4 a, vec4 b, vec4 c, vec4 d) { return 0.5625 * (b + c) - 0.0625 * (a + d); }

// Four pixels interpolated from the ray grid of every 2nd pixel: at a grid point, right of it, below it, and diagonally below.
struct FourPixels {
  vec4 here, right, below, diagonal;
};

FourPixels four_pixels(texture2D half_resolution, ivec2 point) {
  const ivec2 first = point + (COARSE_APRON - 1);
  vec4 on[4], between[4];  // four rows: values at the point, and at the midpoint to the next point
  for (int k = 0; k < 4; ++k) {
    const vec4 a = texelFetch(half_resolution, first + ivec2(0, k), 0), b = texelFetch(half_resolution, first + ivec2(1, k), 0);
    const vec4 c = texelFetch(half_resolution, first + ivec2(2, k), 0), d = texelFetch(half_resolution, first + ivec2(3, k), 0);
    on[k] = b;
    between[k] = interpolate_midpoint(a, b, c, d);
  }
  return FourPixels(on[1], between[1], interpolate_midpoint(on[0], on[1], on[2], on[3]), interpolate_midpoint(between[0], between[1], between[2], between[3]));
}

// Clamps the overshoot of cubic interpolation to valid premultiplied colors.
vec4 clamp_premultiplied(vec4 c) { return vec4(max(c.rgb, vec3(0.0)), clamp(c.a, 0.0, 1.0)); }
