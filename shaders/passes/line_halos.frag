// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// Depth-dependent halos of lines (M. H. Everts et al., IEEE TVCG 15, 2009), in the image: what lies behind a line is darkened beside it, the
// more the farther behind. Lines at the same depth have none, so that a bundle stays a bundle. Black with alpha, to be blended over.
#include "shaders/shared/frame.h"
#include "shaders/shared/line_halos.h"

layout(scalar, binding = 0) uniform Halos { LineHaloData halos; };
layout(binding = 1) uniform texture2D opaque_depth;
layout(binding = 2) uniform utexture2D opaque_id;
layout(location = 0) out vec4 out_color;

bool is_line(uint id) { return id < 32u * LINE_ID_WORDS && (halos.is_line[id >> 5u] >> (id & 31u) & 1u) == 1u; }

void main() {
  const ivec2 p = ivec2(gl_FragCoord.xy), last = textureSize(opaque_depth, 0) - 1;
  const float t = texelFetch(opaque_depth, p, 0).r;
  if (t >= NO_DEPTH) discard;
  float dark = 0.0;
  ivec2 side = ivec2(1, 0), corner = ivec2(1, 1);
  for (int i = 0; i < halos.directions; ++i) {
    const ivec2 s = (i & 1) == 0 ? side : corner;
    for (int k = 1; k <= halos.reach; ++k) {
      const ivec2 q = clamp(p + k * s, ivec2(0), last);
      const float gap = t - texelFetch(opaque_depth, q, 0).r;
      if (gap > halos.least_gap && is_line(texelFetch(opaque_id, q, 0).r)) {
        const float near = clamp(1.0 - (length(vec2(k * s)) - 1.0) / float(halos.reach), 0.0, 1.0);
        dark = max(dark, near * clamp((gap - halos.least_gap) / (halos.full_gap - halos.least_gap), 0.0, 1.0));
      }
    }
    if ((i & 1) == 1) {
      side = ivec2(-side.y, side.x);
      corner = ivec2(-corner.y, corner.x);
    }
  }
  if (dark == 0.0) discard;
  out_color = vec4(0.0, 0.0, 0.0, halos.darkness * dark);
}
