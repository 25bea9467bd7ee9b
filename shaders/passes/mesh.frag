// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/frame.h"

layout(scalar, binding = 0) uniform Frame { MeshFrameData frame; };
#include "shaders/lib/lighting.glsl"
#include "shaders/lib/light_grid.glsl"
#include "shaders/lib/mesh_color.glsl"
layout(location = 0) out vec4 out_color;
layout(location = 1) out float out_depth;
layout(location = 2) out uint out_id;

void main() {
  receive_on_surface(frame.light_grid.from_view * in_view + frame.light_grid.origin, in_normal, to_camera());
  out_color = vec4(mesh_color(), 1.0);
  out_depth = in_depth;
  out_id = in_id;
}
