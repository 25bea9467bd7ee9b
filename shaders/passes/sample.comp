// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// Samples a grid at given local positions exactly as the raycast does; 1e30 in an invalid cell. Used by tests.
#include "shaders/shared/frame.h"
#define GRID_COUNT 1
#include "shaders/lib/grids.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = 1) readonly buffer Positions { vec3 positions[]; };
layout(scalar, binding = 2) writeonly buffer Values { float values[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= positions.length()) return;
  const vec3 p = positions[i];
  values[i] = cell_is_valid(0, cell_of(0, p)) ? sample_value(0, p) : 1e30;
}
