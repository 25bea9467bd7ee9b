#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// One view's finished picture (straight alpha) into its part of the packed one: moved, averaged over a block, or every n-th pixel.
#include "shaders/shared/pack.h"

layout(constant_id = 0) const uint PATTERN = PACK_WHOLE;
layout(scalar, binding = 0) uniform Pack { PackData pack; };
layout(binding = 1) uniform texture2D picture;
layout(location = 0) out vec4 out_color;

void main() {
  const uvec2 at = uvec2(gl_FragCoord.xy - pack.first);
  if (PATTERN != PACK_WHOLE) {
    const uint place = PATTERN == PACK_ROWS ? at.y : PATTERN == PACK_COLUMNS ? at.x : at.x + at.y;
    if (place % pack.views != pack.view) discard;
  }
  const uvec2 block = uvec2(pack.block_x, pack.block_y);
  if (block == uvec2(1)) {
    out_color = texelFetch(picture, ivec2(at), 0);
    return;
  }
  vec4 sum = vec4(0.0);
  for (uint y = 0; y < block.y; ++y)
    for (uint x = 0; x < block.x; ++x) {
      const vec4 c = texelFetch(picture, ivec2(at * block + uvec2(x, y)), 0);
      sum += vec4(c.rgb * c.a, c.a);
    }
  out_color = sum.a > 0.0 ? vec4(sum.rgb / sum.a, sum.a / float(block.x * block.y)) : vec4(0.0);
}
