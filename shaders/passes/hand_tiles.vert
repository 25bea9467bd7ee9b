// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// One instance per tile of HAND_TILE x HAND_TILE texels of hand_mask.frag: two triangles if one of them is 1, else none.
#include "shaders/shared/frame.h"
#include "shaders/shared/hand_shadow.h"
layout(scalar, binding = 7) uniform Hand { HandShadowData hand; };
layout(binding = 9) uniform utexture2D mask;

void main() {
  const int across = int(hand.tiles_across);
  const ivec2 first = ivec2(hand.mask_x, hand.mask_y) + HAND_TILE * ivec2(gl_InstanceIndex % across, gl_InstanceIndex / across);
  const ivec2 last = ivec2(hand.mask_last_x, hand.mask_last_y);
  uint any = 0u;
  for (int y = 0; y < HAND_TILE; ++y)
    for (int x = 0; x < HAND_TILE; ++x) any |= texelFetch(mask, min(first + ivec2(x, y), last), 0).r;
  const int corner = gl_VertexIndex < 3 ? gl_VertexIndex : gl_VertexIndex - 2;  // 0 1 2, 1 2 3
  const vec2 at = float(HAND_SPACING) * vec2(first + HAND_TILE * ivec2(corner & 1, corner >> 1));
  gl_Position = any != 0u ? vec4(at / vec2(hand.half_width, hand.half_height) - 1.0, 0.0, 1.0) : vec4(-2.0, -2.0, 0.0, 1.0);
}
