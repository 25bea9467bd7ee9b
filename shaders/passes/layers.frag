// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// Translucent layers without a volume or translucent isosurface.
#include "shaders/shared/frame.h"
layout(constant_id = 0) const uint HAS_OPAQUE = 0;
layout(constant_id = 1) const int LAYER_COUNT = 1;
layout(scalar, binding = 0) uniform Frame { FrameData frame; };
layout(binding = 2) uniform texture2D opaque_depth;
layout(location = 0) out vec4 out_color;  // premultiplied
#include "shaders/lib/layers.glsl"

void main() {
  const ivec2 at = ivec2(frame.spacing * gl_FragCoord.xy + frame.first);
  const float end = HAS_OPAQUE != 0u ? texelFetch(opaque_depth, at, 0).r : NO_DEPTH;
  vec4 sum = vec4(0.0);
  for (int k = 0; k < LAYER_COUNT && layer_depth(k, at, end) < NO_DEPTH; ++k) sum += (1.0 - sum.a) * layer_color(k, at);
  out_color = sum;
}
