// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// Opaque isosurface: the first crossing along the pixel's ray, shaded, with its exact depth.
#include "shaders/shared/frame.h"
#define GRID_COUNT 1
#include "shaders/lib/grids.glsl"
#include "shaders/lib/rays.glsl"
#include "shaders/lib/lighting.glsl"
#include "shaders/lib/light_grid.glsl"
layout(constant_id = 1) const uint HAS_CELLS = 0;  // 0: there is no cell map
#define SURFACE_CELLS
#include "shaders/lib/surface.glsl"

layout(location = 0) out vec4 out_color;
layout(location = 1) out float out_depth;
layout(location = 2) out uint out_id;

// Loops with at most one iteration replace branches: lavapipe skips a loop that no pixel of a group enters, but not a branch.
void main() {
  const vec2 q = pixel_position();
  const LocalRay ray = local_ray(0, q);
  const vec2 interval = visible_interval(0, ray, q);
  float t = NO_DEPTH;
  if (interval.x < interval.y) t = first_crossing(0, ray, interval.x, interval.y);
  vec3 color = vec3(0.0);
  for (bool hit = t < NO_DEPTH; hit; hit = t < -NO_DEPTH) {
    const vec3 p = clamp(ray.origin + t * ray.direction, frame.grids[0].lo, frame.grids[0].hi);
    const vec3 gradient = world_gradient(0, p), to_camera = -normalize(world_direction(q));
    // the side on which the ray comes, which the gradient over several cells may miss
    const float before = sample_value(0, p - 0.05 * normalize(ray.direction));
    receive_on_level(light_at(q, t), gradient, before >= frame.grids[0].level);
    color = fogged(lit(frame.grids[0].color, gradient, to_camera), t);
  }
  if (t >= NO_DEPTH) discard;
  out_color = vec4(color, 1.0);
  out_depth = t;
  out_id = frame.grids[0].id;
  gl_FragDepth = buffer_depth(t);
}
