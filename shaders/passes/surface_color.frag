// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// Color of an opaque isosurface (grid 0) by another field (grid 1), at pixels where it is the nearest item.
#include "shaders/shared/frame.h"
#define GRID_COUNT 2
#include "shaders/lib/grids.glsl"
#include "shaders/lib/rays.glsl"
#include "shaders/lib/lighting.glsl"
#include "shaders/lib/light_grid.glsl"
#include "shaders/lib/tables.glsl"
#include "shaders/lib/color_by.glsl"

layout(binding = 2) uniform texture2D opaque_depth;
layout(binding = 27) uniform utexture2D opaque_id;
layout(location = 0) out vec4 out_color;

void main() {
  const ivec2 at = ivec2(gl_FragCoord.xy);
  if (texelFetch(opaque_id, at, 0).r != frame.grids[0].id) discard;
  const vec2 q = pixel_position();
  const float t = texelFetch(opaque_depth, at, 0).r;
  const LocalRay ray = local_ray(0, q), other = local_ray(1, q);
  const vec3 p = clamp(ray.origin + t * ray.direction, frame.grids[0].lo, frame.grids[0].hi);
  const vec3 color = color_at(1, other.origin + t * other.direction, frame.grids[0].color);
  const vec3 gradient = world_gradient(0, p), to_camera = -normalize(world_direction(q));
  receive_on_level(light_at(q, t), gradient, dot(gradient, to_camera) > 0.0);
  out_color = vec4(fogged(lit(color, gradient, to_camera), t), 1.0);
}
