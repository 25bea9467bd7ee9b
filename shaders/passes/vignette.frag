// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
// Black that increases with the angle from the view axis; straight alpha, blended over the image.
#include "shaders/shared/vignette.h"

layout(scalar, binding = 0) uniform Data { VignetteData data; };
layout(location = 0) out vec4 out_color;

void main() {
  const float tangent = length(data.first + gl_FragCoord.xy * data.step);
  out_color = vec4(0.0, 0.0, 0.0, data.strength * smoothstep(data.inner, data.outer, tangent));
}
