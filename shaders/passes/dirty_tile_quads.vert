// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// One instance per tile of 16 x 16 pixels: two triangles if the tile is dirty (dirty_tiles.frag), else none.
#include "shaders/shared/frame.h"
layout(scalar, binding = 0) uniform Frame { FrameData frame; };
layout(binding = 35) uniform utexture2D dirty_tiles;

void main() {
  const ivec2 tiles = textureSize(dirty_tiles, 0), tile = ivec2(gl_InstanceIndex % tiles.x, gl_InstanceIndex / tiles.x);
  const int corner = gl_VertexIndex < 3 ? gl_VertexIndex : gl_VertexIndex - 2;  // 0 1 2, 1 2 3
  const vec2 pixel = 16.0 * vec2(tile + ivec2(corner & 1, corner >> 1));
  gl_Position = texelFetch(dirty_tiles, tile, 0).r != 0u ? vec4(pixel / frame.half_size - 1.0, 0.0, 1.0) : vec4(-2.0, -2.0, 0.0, 1.0);
}
