// SPDX-License-Identifier: MIT
// Conversion between the display (sRGB) encoding of colors and linear radiance (render/frame/linear_color.h).
vec3 to_linear(vec3 c) { return mix(pow((max(c, 0.0) + 0.055) / 1.055, vec3(2.4)), c / 12.92, lessThanEqual(c, vec3(0.04045))); }
vec3 to_display(vec3 c) { return mix(1.055 * pow(max(c, 0.0), vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308))); }

// Returns a premultiplied color with the color, not the coverage, in the display encoding. A loop with at most one iteration replaces a
// branch on a uniform (rays.glsl).
vec4 premultiplied_to_display(vec4 c, float is_linear, vec2 at) {
  for (float on = is_linear + float(at.x < -1e30); on > 0.0 && c.a > 0.0; on = 0.0) c.rgb = c.a * to_display(c.rgb / c.a);
  return c;
}
