// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// Converts the nearer of the opaque depth and the rays' depth to a depth buffer in meters: d = f / (f - n) (1 - n / z); 1: no surface.
#include "shaders/shared/headset.h"

layout(constant_id = 0) const uint HAS_OPAQUE = 0;
layout(constant_id = 1) const int RAY_SPACING = 0;  // pixels between the rays with known depth; 0: none

layout(scalar, binding = 0) uniform Depth { HeadsetDepthData depth; };
layout(binding = 1) uniform texture2D opaque_depth;
layout(binding = 2) uniform texture2D ray_depth;

void main() {
  const ivec2 at = ivec2(gl_FragCoord.xy);
  float units = NO_DEPTH;
  if (HAS_OPAQUE != 0u) units = texelFetch(opaque_depth, at, 0).r;
  if (RAY_SPACING > 0) {
    const ivec2 nearest = min((at + RAY_SPACING / 2) / max(RAY_SPACING, 1), textureSize(ray_depth, 0) - 1);
    units = min(units, texelFetch(ray_depth, nearest, 0).r);
  }
  const float z = max(depth.reference_m + depth.meters_per_unit * units, depth.near_m);
  const float d = depth.far_m / (depth.far_m - depth.near_m) * (1.0 - depth.near_m / z);
  gl_FragDepth = units >= NO_DEPTH ? 1.0 : clamp(d, 0.0, 1.0);
}
