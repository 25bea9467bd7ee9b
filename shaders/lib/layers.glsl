// SPDX-License-Identifier: MIT
// Translucent triangle layers, the nearest first: premultiplied colors, and depths. The includer defines LAYER_COUNT.
layout(binding = 27) uniform texture2D layer_color_0;
layout(binding = 28) uniform texture2D layer_color_1;
layout(binding = 29) uniform texture2D layer_color_2;
layout(binding = 30) uniform texture2D layer_color_3;
layout(binding = 31) uniform texture2D layer_depth_0;
layout(binding = 32) uniform texture2D layer_depth_1;
layout(binding = 33) uniform texture2D layer_depth_2;
layout(binding = 34) uniform texture2D layer_depth_3;

vec4 layer_color(int k, ivec2 at) {
  switch (k) {
    case 0: return texelFetch(layer_color_0, at, 0);
    case 1: return texelFetch(layer_color_1, at, 0);
    case 2: return texelFetch(layer_color_2, at, 0);
    default: return texelFetch(layer_color_3, at, 0);
  }
}

float layer_texel(int k, ivec2 at) {
  switch (k) {
    case 0: return texelFetch(layer_depth_0, at, 0).r;
    case 1: return texelFetch(layer_depth_1, at, 0).r;
    case 2: return texelFetch(layer_depth_2, at, 0).r;
    default: return texelFetch(layer_depth_3, at, 0).r;
  }
}

// Returns the depth of layer k if it is less than `end`; NO_DEPTH: neither this layer nor those behind it are visible.
float layer_depth(int k, ivec2 at, float end) {
  if (k >= LAYER_COUNT) return NO_DEPTH;
  const float t = layer_texel(k, at);
  return t < end ? t : NO_DEPTH;
}
