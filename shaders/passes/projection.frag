// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// One value per ray: the exact maximum or minimum along it, or the mean of the values at the middles of its segments.
#include "shaders/shared/frame.h"
#define GRID_COUNT 1
#include "shaders/lib/grids.glsl"
#include "shaders/lib/rays.glsl"
#include "shaders/lib/tables.glsl"

layout(constant_id = 1) const uint HAS_OPAQUE = 0;
layout(constant_id = 2) const uint PROJECTION_KIND = 1;  // 1 maximum, 2 minimum, 3 average
layout(binding = 2) uniform texture2D opaque_depth;
layout(location = 0) out vec4 out_color;  // premultiplied

#include "shaders/lib/projection.glsl"

void main() {
  const vec2 q = pixel_position();
  const LocalRay ray = local_ray(0, q);
  vec2 interval = visible_interval(0, ray, q);
  if (HAS_OPAQUE != 0u) interval.y = min(interval.y, texelFetch(opaque_depth, ivec2(q + frame.axis), 0).r);
  float value = NO_DEPTH;
  if (interval.x < interval.y) value = PROJECTION_KIND == 3u ? find_average(ray, interval, frame.step_world / length(world_direction(q))) : find_extremum(ray, interval);
  out_color = vec4(0.0);
  if (value < NO_DEPTH) {
    uint at;
    float way;
    find_entry(frame.grids[0].value_table, value, at, way);
    vec4 c = interpolate_entry(at, way);
    c.a = 1.0 - exp(-c.a * frame.grids[0].opacity);
    out_color = vec4(c.a * c.rgb, c.a);
  }
}
