// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// Opaque isosurface of a paged volume: the first crossing along the pixel's ray, shaded, with its exact depth.
#include "shaders/shared/frame.h"
#include "shaders/shared/fast_volume.h"
layout(scalar, binding = 0) uniform Frame { FrameData frame; };
#define BRICK_SIZE 8
#include "shaders/lib/rays.glsl"
#include "shaders/lib/lighting.glsl"
#include "shaders/lib/light_grid.glsl"
const float seen_transmittance = 1.0;
#define HAS_NUMBERS
#include "shaders/lib/paged.glsl"
#include "shaders/lib/surface_paged.glsl"

layout(location = 0) out vec4 out_color;
layout(location = 1) out float out_depth;
layout(location = 2) out uint out_id;

void main() {
  const vec2 q = pixel_position();
  const LocalRay ray = local_ray(0, q);
  const vec2 interval = visible_interval(0, ray, q);
  float t = NO_DEPTH;
  if (interval.x < interval.y) t = first_crossing(ray, interval.x, interval.y, frame.grids[0].level);
  if (t >= NO_DEPTH) discard;
  const vec3 p = clamp(ray.origin + t * ray.direction, frame.grids[0].lo, frame.grids[0].hi);
  const vec3 gradient = frame.grids[0].world_gradient * smooth_gradient(p, sample_packed(p));
  const vec3 to_camera = -normalize(world_direction(q));
  receive_on_level(light_at(q, t), gradient, dot(gradient, to_camera) > 0.0);
  out_color = vec4(fogged(lit(frame.grids[0].color, gradient, to_camera), t), 1.0);
  out_depth = t;
  out_id = frame.grids[0].id;
  gl_FragDepth = buffer_depth(t);
}
