// SPDX-License-Identifier: MIT
#version 460
#extension GL_EXT_samplerless_texture_functions : require
// Resolves the last layer from the sums of peel.glsl.
layout(binding = 0) uniform texture2D collected;
layout(location = 0) out vec4 out_color;

void main() {
  const vec4 sum = texelFetch(collected, ivec2(gl_FragCoord.xy), 0);
  const float weight = -log(max(sum.a, 1e-37));
  out_color = sum.a < 1.0 && weight > 0.0 ? vec4(sum.rgb / weight * (1.0 - sum.a), 1.0 - sum.a) : vec4(0.0);
}
