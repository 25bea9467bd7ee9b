#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// One instance a tile of 16 x 16 pixels: two triangles over it if one of its 4 x 4 blocks is marked, else none.
#include "shaders/shared/frame.h"
layout(scalar, binding = 0) uniform Frame { FrameData frame; };
layout(binding = 7) uniform utexture2D blocks;

void main() {
  const ivec2 size = textureSize(blocks, 0), tiles = (size + 3) / 4;
  const ivec2 tile = ivec2(gl_InstanceIndex % tiles.x, gl_InstanceIndex / tiles.x);
  uint marked = 0u;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) marked |= texelFetch(blocks, min(4 * tile + ivec2(x, y), size - 1), 0).r;
  const int corner = gl_VertexIndex < 3 ? gl_VertexIndex : gl_VertexIndex - 2;  // 0 1 2, 1 2 3
  const vec2 pixel = 16.0 * vec2(tile + ivec2(corner & 1, corner >> 1));
  gl_Position = marked != 0u ? vec4(pixel / frame.half_size - 1.0, 0.0, 1.0) : vec4(-2.0, -2.0, 0.0, 1.0);
}
