// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// Isosurfaces of an earlier image (render/passes/surface_cache.h), drawn among the current opaque items.
#include "shaders/shared/frame.h"
layout(scalar, binding = 0) uniform Frame { FrameData frame; };
layout(binding = 1) uniform texture2D colors;
layout(binding = 2) uniform texture2D depths;
layout(binding = 3) uniform utexture2D ids;
layout(location = 0) out vec4 out_color;
layout(location = 1) out float out_depth;
layout(location = 2) out uint out_id;

#define BRICK_SIZE 8
#include "shaders/lib/rays.glsl"

void main() {
  const ivec2 at = ivec2(gl_FragCoord.xy);
  const float t = texelFetch(depths, at, 0).r;
  if (t >= NO_DEPTH) discard;
  out_color = texelFetch(colors, at, 0);
  out_depth = t;
  out_id = texelFetch(ids, at, 0).r;
  gl_FragDepth = buffer_depth(t);
}
