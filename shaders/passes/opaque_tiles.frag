// SPDX-License-Identifier: MIT
#version 460
#extension GL_EXT_samplerless_texture_functions : require
// Tiles of 4 x 4 pixels: 1 if an opaque surface is visible; and a hash of the depths, which shows whether they have changed.
layout(binding = 0) uniform texture2D opaque_depth;
layout(location = 0) out uint out_mark;
layout(location = 1) out uvec2 out_hash;

// Mixing step of MurmurHash3 (A. Appleby), shortened; the second half of the hash uses another constant.
uint mix_hash(uint h, uint word, uint by) {
  h ^= word;
  h *= by;
  return h ^ (h >> 15);
}

void main() {
  const ivec2 first = 4 * ivec2(gl_FragCoord.xy), last = textureSize(opaque_depth, 0) - 1;
  float nearest = 3.0e38;
  uvec2 hash = uvec2(0x9747b28cu, 0x3c6ef372u);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) {
      const float depth = texelFetch(opaque_depth, min(first + ivec2(x, y), last), 0).r;
      nearest = min(nearest, depth);
      const uint word = floatBitsToUint(depth);
      hash = uvec2(mix_hash(hash.x, word, 0x85ebca6bu), mix_hash(hash.y, word, 0xc2b2ae35u));
    }
  out_mark = nearest < 3.0e38 ? 1u : 0u;
  out_hash = hash;
}
