#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// Several volumes and translucent isosurfaces together: the ray is cut where a volume begins or ends and at surfaces.
#include "shaders/shared/frame.h"
#define GRID_COUNT MAX_GRIDS
layout(constant_id = 2) const int VOLUMES = 1;   // grids 0 .. VOLUMES - 1
layout(constant_id = 3) const int SURFACES = 0;  // the grids after them
#include "shaders/lib/grids.glsl"
#include "shaders/lib/rays.glsl"
#include "shaders/lib/lighting.glsl"
#include "shaders/lib/surface.glsl"
#include "shaders/lib/raycast.glsl"

// The surfaces, by their number, which is a constant here too.
float crossings[MAX_SURFACES];  // the next one
float limits[MAX_SURFACES];

void meet_surface(int s, vec2 q, float end) {
  const int i = VOLUMES + s;
  if (s < SURFACES) {
    rays[i] = local_ray(i, q);
    const vec2 interval = visible_interval(i, rays[i], q);
    limits[s] = min(interval.y, end);
    crossings[s] = NO_DEPTH;
    if (interval.x < limits[s]) crossings[s] = first_crossing(i, rays[i], interval.x, limits[s]);
  }
}

// Blends surface s, if it is the one that the ray crosses at t, and looks for its next crossing a little way behind.
void pass_surface(int s, int surface, float t) {
  const int i = VOLUMES + s;
  if (s < SURFACES && s == surface && through > frame.termination) {
    const vec3 p = clamp(rays[i].origin + t * rays[i].direction, frame.grids[i].lo, frame.grids[i].hi);
    const float opacity = frame.grids[i].opacity;
    color_sum += through * opacity * fogged(lit(frame.grids[i].color, world_gradient(i, p), eye_direction), t);
    surfaces_through *= 1.0 - opacity;
    through *= 1.0 - opacity;
    const float past = t + 1e-3 / max(max(abs(rays[i].direction.x), abs(rays[i].direction.y)), abs(rays[i].direction.z));
    crossings[s] = NO_DEPTH;
    if (past < limits[s]) crossings[s] = first_crossing(i, rays[i], past, limits[s]);
  }
}

void main() {
  const vec2 q = pixel_place();
  const float end = begin_pixel(q);

  // where the ray meets each grid
  for (int i = 0; i < VOLUMES; ++i) {
    rays[i] = local_ray(i, q);
    intervals[i] = seen_interval(i, q, end);
  }
  meet_surface(0, q, end);
  meet_surface(1, q, end);
  meet_surface(2, q, end);
  meet_surface(3, q, end);
  float t = NO_DEPTH;
  for (int i = 0; i < VOLUMES; ++i) t = min(t, intervals[i].x);
  for (int s = 0; s < SURFACES; ++s) t = min(t, crossings[s]);

  // from event to event: a volume begins or ends, a surface is crossed
  for (int guard = 0; guard < 4096 && through > frame.termination && t < end; ++guard) {
    float next = NO_DEPTH;
    int surface = -1;
    bool inside = false;
    for (int i = 0; i < VOLUMES; ++i) {
      if (intervals[i].x > t) next = min(next, intervals[i].x);
      else if (intervals[i].y > t) {
        next = min(next, intervals[i].y);
        if (intervals[i].x < NO_DEPTH) inside = true;
      }
    }
    for (int s = 0; s < SURFACES; ++s)
      if (crossings[s] <= next && crossings[s] < NO_DEPTH) {
        next = crossings[s];
        surface = s;
      }
    if (next >= NO_DEPTH) break;
    if (inside && next > t) march(t, next);
    t = max(t, next);
    pass_surface(0, surface, t);
    pass_surface(1, surface, t);
    pass_surface(2, surface, t);
    pass_surface(3, surface, t);
  }
  out_color = vec4(color_sum, 1.0 - through);
}
