// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// Marks the 4 x 4 blocks of a ray grid whose interpolation from the coarser one is expected to exceed the threshold. The error of the
// four-point cubic at the midpoint is 3 / 128 of the fourth difference; the maximum over the block's coarser rays, along both axes, counts.
// Where the rays alternate (the fourth difference is then four times the second), they tell little about the values between them, and thin
// features may be hidden there: the expected error is up to three times as large. Near an opaque item rays end at different depths: every
// such block is marked.
#include "shaders/shared/fast_volume.h"

layout(scalar, binding = 0) uniform RayGrid { RayGridData ray_grid; };
layout(binding = 1) uniform texture2D coarser;
layout(constant_id = 0) const uint HAS_OPAQUE = 0;
layout(binding = 2) uniform utexture2D opaque_tiles;
layout(location = 0) out uint out_mark;

vec4 texel(ivec2 at) { return texelFetch(coarser, clamp(at, ivec2(0), ivec2(ray_grid.width, ray_grid.height) - 1), 0); }

// Returns the expected error times 128 / 3.
vec4 expected_error(vec4 a, vec4 b, vec4 c, vec4 d, vec4 e) {
  const vec4 second = abs(b + d - 2.0 * c), fourth = abs(a + e - 4.0 * (b + d) + 6.0 * c);
  return fourth * (1.0 + 2.0 * min(vec4(1.0), fourth / max(4.0 * second, vec4(1e-6))));
}

vec4 max_error_along(ivec2 at, ivec2 step) {
  const vec4 a = texel(at), b = texel(at + step), c = texel(at + 2 * step), d = texel(at + 3 * step);
  const vec4 e = texel(at + 4 * step), f = texel(at + 5 * step), g = texel(at + 6 * step);
  return max(expected_error(a, b, c, d, e), max(expected_error(b, c, d, e, f), expected_error(c, d, e, f, g)));
}

// Returns whether an opaque item lies within the reach of the block's interpolation, two coarser rays around it.
bool opaque_near() {
  const int spacing = int(ray_grid.spacing);
  const ivec2 begin = spacing * (4 * ivec2(gl_FragCoord.xy) - int(ray_grid.apron)) - 4 * spacing, size = textureSize(opaque_tiles, 0);
  const ivec2 from = clamp(begin >> 2, ivec2(0), size - 1), to = clamp((begin + 12 * spacing) >> 2, ivec2(0), size - 1);
  uint any = 0u;
  for (int y = from.y; y <= to.y; ++y)
    for (int x = from.x; x <= to.x; ++x) any |= texelFetch(opaque_tiles, ivec2(x, y), 0).r;
  return any != 0u;
}

void main() {
  const ivec2 first = 2 * ivec2(gl_FragCoord.xy) - int(ray_grid.apron) / 2 + COARSE_APRON;  // the block's first coarser ray
  vec4 worst = vec4(0.0);
  worst = max(worst, max_error_along(first + ivec2(-2, 0), ivec2(1, 0)));
  worst = max(worst, max_error_along(first + ivec2(-2, 1), ivec2(1, 0)));
  worst = max(worst, max_error_along(first + ivec2(-2, 2), ivec2(1, 0)));
  worst = max(worst, max_error_along(first + ivec2(0, -2), ivec2(0, 1)));
  worst = max(worst, max_error_along(first + ivec2(1, -2), ivec2(0, 1)));
  worst = max(worst, max_error_along(first + ivec2(2, -2), ivec2(0, 1)));
  const vec2 pixel = ray_grid.spacing * (4.0 * floor(gl_FragCoord.xy) + 2.0 - ray_grid.apron);
  const vec2 off = (pixel - ray_grid.gaze) * ray_grid.per_fovea;
  const float threshold = ray_grid.threshold * max(1.0, dot(off, off));
  out_mark = (3.0 / 128.0) * max(max(worst.r, worst.g), max(worst.b, worst.a)) > threshold ? 1u : 0u;
  if (HAS_OPAQUE != 0u && opaque_near()) out_mark = 1u;
}
