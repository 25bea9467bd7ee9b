// SPDX-License-Identifier: MIT
#version 460
#extension GL_EXT_samplerless_texture_functions : require
// Tiles of 16 x 16 pixels. DILATION 0: 1 if the hash of one of its 4 x 4 blocks (opaque_tiles.frag) has changed. DILATION > 0: 1 if a tile
// within that distance is 1.
layout(constant_id = 0) const int DILATION = 0;
layout(binding = 0) uniform utexture2D before;  // hashes of the previous image; DILATION > 0: tiles
layout(binding = 1) uniform utexture2D now;
layout(location = 0) out uint out_dirty;

void main() {
  const ivec2 tile = ivec2(gl_FragCoord.xy), last = textureSize(before, 0) - 1;
  uint changed = 0u;
  if (DILATION == 0) {
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 4; ++x) {
        const ivec2 block = min(4 * tile + ivec2(x, y), last);
        if (texelFetch(before, block, 0).rg != texelFetch(now, block, 0).rg) changed = 1u;
      }
  } else {
    const ivec2 from = max(tile - DILATION, ivec2(0)), to = min(tile + DILATION, last);
    for (int y = from.y; y <= to.y; ++y)
      for (int x = from.x; x <= to.x; ++x) changed |= texelFetch(before, ivec2(x, y), 0).r;
  }
  out_dirty = changed;
}
