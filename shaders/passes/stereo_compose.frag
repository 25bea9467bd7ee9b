// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// Copies one view's image (straight alpha) into its part of the packed image: shifted, averaged over blocks, or every n-th pixel.
#include "shaders/shared/stereo_compose.h"

layout(constant_id = 0) const uint PATTERN = STEREO_PATTERN_WHOLE;
layout(scalar, binding = 0) uniform StereoCompose { StereoComposeData compose; };
layout(binding = 1) uniform texture2D image;
layout(location = 0) out vec4 out_color;

void main() {
  const uvec2 at = uvec2(gl_FragCoord.xy - compose.first);
  if (PATTERN != STEREO_PATTERN_WHOLE) {
    const uint index = PATTERN == STEREO_PATTERN_ROWS ? at.y : PATTERN == STEREO_PATTERN_COLUMNS ? at.x : at.x + at.y;
    if (index % compose.views != compose.view) discard;
  }
  const uvec2 block = uvec2(compose.block_x, compose.block_y);
  if (block == uvec2(1)) {
    out_color = texelFetch(image, ivec2(at), 0);
    return;
  }
  vec4 sum = vec4(0.0);
  for (uint y = 0; y < block.y; ++y)
    for (uint x = 0; x < block.x; ++x) {
      const vec4 c = texelFetch(image, ivec2(at * block + uvec2(x, y)), 0);
      sum += vec4(c.rgb * c.a, c.a);
    }
  out_color = sum.a > 0.0 ? vec4(sum.rgb / sum.a, sum.a / float(block.x * block.y)) : vec4(0.0);
}
