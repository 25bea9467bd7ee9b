// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
// Positions in window pixels, y down.
#include "shaders/shared/ui.h"

layout(scalar, binding = 0) uniform Data { UiData data; };
layout(location = 0) in vec2 in_position;
layout(location = 1) in vec2 in_texture;
layout(location = 2) in vec4 in_color;
layout(location = 0) out vec2 out_texture;
layout(location = 1) out vec4 out_color;

void main() {
  gl_Position = vec4(in_position / data.half_size - 1.0, 0.0, 1.0);
  out_texture = in_texture;
  out_color = in_color;
}
