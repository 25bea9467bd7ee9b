// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// Interpolates a volume at full resolution from every 2nd pixel, before marked tiles are marched (volume_fast.frag). One invocation per ray
// grid point.
#include "shaders/shared/fast_volume.h"

layout(local_size_x = 16, local_size_y = 4) in;
layout(scalar, binding = 0) uniform Upsample { UpsampleData upsample; };
layout(binding = 1) uniform texture2D half_resolution;
layout(binding = 2, rgba32f) uniform writeonly image2D volume;
layout(constant_id = 0) const uint REUSES = 0;  // unchanged tiles are kept
layout(binding = 3) uniform utexture2D dirty_tiles;
#include "shaders/lib/four_point.glsl"

void put(ivec2 at, vec4 c) {
  if (at.x < int(upsample.width) && at.y < int(upsample.height)) imageStore(volume, at, clamp_premultiplied(c));
}

void main() {
  const ivec2 point = ivec2(gl_GlobalInvocationID.xy) + ivec2(upsample.first_x, upsample.first_y);
  if (REUSES != 0u && texelFetch(dirty_tiles, min(point >> 3, textureSize(dirty_tiles, 0) - 1), 0).r == 0u) return;
  const FourPixels p = four_pixels(half_resolution, point);
  put(2 * point, p.here);
  put(2 * point + ivec2(1, 0), p.right);
  put(2 * point + ivec2(0, 1), p.below);
  put(2 * point + ivec2(1, 1), p.diagonal);
}
