#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// One value a ray: the greatest or least that it meets, exactly, or the mean at the middles of its segments. The table holds opacities.
#include "shaders/shared/frame.h"
#define GRID_COUNT 1
#include "shaders/lib/grids.glsl"
#include "shaders/lib/rays.glsl"
#include "shaders/lib/tables.glsl"

layout(constant_id = 1) const uint OPAQUE = 0;
layout(constant_id = 2) const uint KIND = 1;  // 1 maximum, 2 minimum, 3 average
layout(binding = 2) uniform texture2D opaque_depth;
layout(location = 0) out vec4 out_color;  // premultiplied

#include "shaders/lib/projection.glsl"

void main() {
  const vec2 q = pixel_place();
  const LocalRay ray = local_ray(0, q);
  vec2 interval = visible_interval(0, ray, q);
  if (OPAQUE != 0u) interval.y = min(interval.y, texelFetch(opaque_depth, ivec2(q + frame.axis), 0).r);
  float value = NO_DEPTH;
  if (interval.x < interval.y) value = KIND == 3u ? average(ray, interval, frame.step_world / length(world_direction(q))) : extreme(ray, interval);
  out_color = vec4(0.0);
  if (value < NO_DEPTH) {
    const float x = table_place(0, value);
    const uint cell = min(uint(x), frame.grids[0].table_last - 1u);
    const uint at = frame.grids[0].table_start + cell;
    const vec4 c = mix(table[at], table[at + 1u], x - float(cell));
    out_color = vec4(c.a * c.rgb, c.a);
  }
}
