// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// Composes two eyes into an anaglyph: sRGB to linear light, a matrix per eye, clamped, back to sRGB. Light is weighted by alpha; the alpha
// of a pixel is the maximum of both eyes (over an area that only one eye covers, the other counts as black).
#include "shaders/shared/stereo_compose.h"

layout(scalar, binding = 0) uniform Anaglyph { AnaglyphData anaglyph; };
layout(binding = 1) uniform texture2D left_eye;
layout(binding = 2) uniform texture2D right_eye;
layout(location = 0) out vec4 out_color;

vec3 linear_from_srgb(vec3 c) { return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045))); }
vec3 srgb_from_linear(vec3 c) { return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308))); }

void main() {
  const ivec2 at = ivec2(gl_FragCoord.xy);
  const vec4 left = texelFetch(left_eye, at, 0), right = texelFetch(right_eye, at, 0);
  const float alpha = max(left.a, right.a);
  const vec3 light = anaglyph.left * (left.a * linear_from_srgb(left.rgb)) + anaglyph.right * (right.a * linear_from_srgb(right.rgb));
  out_color = alpha > 0.0 ? vec4(srgb_from_linear(clamp(light / alpha, 0.0, 1.0)), alpha) : vec4(0.0);
}
