#version 460
#extension GL_EXT_samplerless_texture_functions : require
// Tiles of 4 x 4 pixels: 1 where something opaque is seen.
layout(binding = 0) uniform texture2D opaque_depth;
layout(location = 0) out uint out_mark;

void main() {
  const ivec2 first = 4 * ivec2(gl_FragCoord.xy), last = textureSize(opaque_depth, 0) - 1;
  float nearest = 3.0e38;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) nearest = min(nearest, texelFetch(opaque_depth, min(first + ivec2(x, y), last), 0).r);
  out_mark = nearest < 3.0e38 ? 1u : 0u;
}
