// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// Output image from a volume on every 2nd pixel: interpolated by the four-point cubic (-1, 9, 9, -1) / 16, over opaque over background (as
// in compose.frag). One invocation per ray grid point: its pixel, and those to the right, below and diagonally below.
#include "shaders/shared/frame.h"
#include "shaders/shared/fast_volume.h"

layout(local_size_x = 16, local_size_y = 4) in;
layout(constant_id = 0) const uint HAS_OPAQUE = 0;
layout(scalar, binding = 0) uniform Upsample { UpsampleData upsample; };
layout(binding = 1) uniform texture2D opaque_color;
layout(binding = 2) uniform texture2D half_resolution;
layout(binding = 3, rgba8) uniform writeonly image2D image;

#include "shaders/lib/four_point.glsl"
#include "shaders/lib/linear_color.glsl"

void finish(ivec2 at, vec4 volume) {
  const vec4 c = clamp_premultiplied(volume);
  vec4 sum = vec4(upsample.background.rgb * upsample.background.a, upsample.background.a);
  if (HAS_OPAQUE != 0u) {
    const vec4 o = texelFetch(opaque_color, at, 0);
    sum = o + (1.0 - o.a) * sum;
  }
  sum = premultiplied_to_display(c + (1.0 - c.a) * sum, upsample.is_linear, vec2(at));
  if (at.x < int(upsample.width) && at.y < int(upsample.height))
    imageStore(image, at, sum.a > 0.0 ? vec4(sum.rgb / sum.a, sum.a) : vec4(0.0));
}

void main() {
  const ivec2 point = ivec2(gl_GlobalInvocationID.xy) + ivec2(upsample.first_x, upsample.first_y);
  const FourPixels p = four_pixels(half_resolution, point);
  finish(2 * point, p.here);
  finish(2 * point + ivec2(1, 0), p.right);
  finish(2 * point + ivec2(0, 1), p.below);
  finish(2 * point + ivec2(1, 1), p.diagonal);
}
