// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// One instance per tile of 16 x 16 texels of a ray grid: two triangles, or none. As RayGridData states, only tiles with a marked 4 x 4
// block, only tiles that overlap a dirty tile of the image, or both. No branch depends on uniforms only (rays.glsl).
#include "shaders/shared/fast_volume.h"
layout(scalar, binding = 1) uniform RayGrid { RayGridData ray_grid; };
layout(binding = 7) uniform utexture2D blocks;
layout(binding = 9) uniform utexture2D dirty_tiles;

void main() {
  const ivec2 size = ivec2(ray_grid.grid_width, ray_grid.grid_height), tiles = (size + 15) / 16;
  const ivec2 tile = ivec2(gl_InstanceIndex % tiles.x, gl_InstanceIndex / tiles.x);
  uint marked = 1u - ray_grid.only_marked;
  const ivec2 last_block = textureSize(blocks, 0) - 1;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) marked |= texelFetch(blocks, min(4 * tile + ivec2(x, y), last_block), 0).r;
  const int spacing = int(ray_grid.spacing), apron = int(ray_grid.apron);
  const ivec2 last = textureSize(dirty_tiles, 0) - 1;
  const ivec2 from = clamp((spacing * (16 * tile - apron)) >> 4, ivec2(0), last);
  const ivec2 to = clamp((spacing * (16 * tile + 15 - apron)) >> 4, ivec2(0), last);
  uint moved = 1u - ray_grid.only_dirty;
  for (int y = from.y; y <= to.y; ++y)
    for (int x = from.x; x <= to.x; ++x) moved |= texelFetch(dirty_tiles, ivec2(x, y), 0).r;
  const int corner = gl_VertexIndex < 3 ? gl_VertexIndex : gl_VertexIndex - 2;  // 0 1 2, 1 2 3
  const vec2 texel = 16.0 * vec2(tile + ivec2(corner & 1, corner >> 1));
  gl_Position = (marked & moved & 1u) != 0u ? vec4(2.0 * texel / vec2(size) - 1.0, 0.0, 1.0) : vec4(-2.0, -2.0, 0.0, 1.0);
}
