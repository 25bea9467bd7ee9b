// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// One fragment per HAND_SPACING x HAND_SPACING pixels: 1 if the hand's shadow may fall on them, by their middle one.
#include "shaders/shared/frame.h"
layout(binding = 4) uniform texture2D opaque_depth;
layout(location = 0) out uint out_mask;
#include "shaders/lib/hand_parts.glsl"

bool may_be_shadowed(ivec2 pixel, float t) {
  const vec3 view = view_position(vec2(pixel) + 0.5, t);
  const float sharp = (2.0 * float(HAND_SPACING) + 1.0) * pixel_width(view);  // up to the next pixels that are tested
  bool may_be = false;
  for (uint k = 0u; k < hand.part_count; ++k)
    for (int i = 0; i < 3; ++i)
      may_be = may_be || (hand.light_tangents[i] >= 0.0 && may_cover(hand.from[k], hand.to[k], view, frame.lights[i].direction, hand.light_tangents[i], sharp));
  return may_be && t < NO_DEPTH;
}

void main() {
  const ivec2 pixel = HAND_SPACING * ivec2(gl_FragCoord.xy) + HAND_SPACING / 2, last = textureSize(opaque_depth, 0) - 1;
  const float t = max(texelFetch(opaque_depth, min(pixel, last), 0).r, hand.least_opaque);
  out_mask = may_be_shadowed(pixel, t) || may_be_shadowed(pixel, half_opacity_depth(pixel)) ? 1u : 0u;
}
