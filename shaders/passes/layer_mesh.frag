// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// Translucent triangles of a layer.
#include "shaders/shared/layers.h"

layout(scalar, binding = 0) uniform Frame { MeshFrameData frame; };
#include "shaders/lib/lighting.glsl"
#include "shaders/lib/light_grid.glsl"
#include "shaders/lib/mesh_color.glsl"
#include "shaders/lib/peel.glsl"

void main() {
  receive_on_surface(frame.light_grid.from_view * in_view + frame.light_grid.origin, in_normal, to_camera());
  write_fragment(true, layer.opacity * mesh_color(), layer.opacity, in_depth, in_id);
}
