// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// One volume: the most frequent case, in a small shader because drivers compile it at first use.
#include "shaders/shared/frame.h"
#define GRID_COUNT 1
#define VOLUME_COUNT 1
#include "shaders/lib/grids.glsl"
#include "shaders/lib/rays.glsl"
#include "shaders/lib/lighting.glsl"
#include "shaders/lib/light_grid.glsl"
#include "shaders/lib/raycast.glsl"

void main() {
  const vec2 q = pixel_position();
  const float end = setup_pixel(q);
  rays[0] = local_ray(0, q);
  intervals[0] = visible_ray_interval(0, q, end);
  if (intervals[0].x < NO_DEPTH) march(intervals[0].x, intervals[0].y);
  out_color = HALF_OPACITY_DEPTH != 0u ? half_opacity_output() : vec4(color_sum, 1.0 - transmittance);
}
