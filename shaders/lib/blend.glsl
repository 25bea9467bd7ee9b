// SPDX-License-Identifier: MIT
// Volumes, translucent isosurfaces and layers along one ray, which is split where a volume begins or ends, at surfaces and at layers. The
// includer defines GRID_COUNT and, with layers, HAS_LAYERS.
layout(constant_id = 2) const int VOLUME_COUNT = 1;   // volumes: grids 0 .. VOLUME_COUNT - 1
layout(constant_id = 3) const int SURFACE_COUNT = 0;  // isosurfaces: the next grids
layout(constant_id = 8) const int COLOR_GRID_COUNT = 0;  // color grids: the grids after the isosurfaces
#include "shaders/lib/grids.glsl"
#include "shaders/lib/rays.glsl"
#include "shaders/lib/lighting.glsl"
#include "shaders/lib/light_grid.glsl"
#include "shaders/lib/surface.glsl"
#include "shaders/lib/raycast.glsl"

// Next crossing of each surface, and the end of its visible interval.
float crossings[MAX_SURFACES];
float limits[MAX_SURFACES];

void init_surface(int s, vec2 q, float end) {
  const int i = VOLUME_COUNT + s;
  if (s < SURFACE_COUNT) {
    rays[i] = local_ray(i, q);
    const vec2 interval = visible_interval(i, rays[i], q);
    limits[s] = min(interval.y, end);
    crossings[s] = NO_DEPTH;
    if (interval.x < limits[s]) crossings[s] = first_crossing(i, rays[i], interval.x, limits[s]);
  }
}

// Blends surface s, if it is the one that the ray crosses at t, and finds its next crossing, 1e-3 voxels behind t.
void shade_surface(int s, int surface, float t) {
  const int i = VOLUME_COUNT + s;
  if (s < SURFACE_COUNT && s == surface && transmittance > frame.termination) {
    const vec3 p = clamp(rays[i].origin + t * rays[i].direction, frame.grids[i].lo, frame.grids[i].hi);
    const float opacity = frame.grids[i].opacity;
    const vec3 gradient = world_gradient(i, p);
    receive_on_level(light_at(light_q, t), gradient, dot(gradient, view_direction) > 0.0);
    color_sum += transmittance * opacity * fogged(lit(resolve_color(i, t, frame.grids[i].color), gradient, view_direction), t);
    surface_transmittance *= 1.0 - opacity;
    transmittance *= 1.0 - opacity;
    const float past = t + 1e-3 / max(max(abs(rays[i].direction.x), abs(rays[i].direction.y)), abs(rays[i].direction.z));
    crossings[s] = NO_DEPTH;
    if (past < limits[s]) crossings[s] = first_crossing(i, rays[i], past, limits[s]);
  }
}

#ifndef HAS_LAYERS
float layer_depth(int k, ivec2 at, float end) { return NO_DEPTH; }
#endif

void main() {
  const vec2 q = pixel_position();
  const float end = setup_pixel(q);

  // the ray's interval in each grid
  for (int j = VOLUME_COUNT + SURFACE_COUNT; j < VOLUME_COUNT + SURFACE_COUNT + COLOR_GRID_COUNT; ++j) rays[j] = local_ray(j, q);
  for (int i = 0; i < VOLUME_COUNT; ++i) {
    rays[i] = local_ray(i, q);
    intervals[i] = visible_ray_interval(i, q, end);
  }
  init_surface(0, q, end);
  init_surface(1, q, end);
  init_surface(2, q, end);
  init_surface(3, q, end);
  init_surface(4, q, end);
  init_surface(5, q, end);
  init_surface(6, q, end);
  init_surface(7, q, end);
  const ivec2 at = ivec2(q + frame.axis);
  int layer = 0;
  float layer_at = layer_depth(0, at, end);
  float t = layer_at;
  for (int i = 0; i < VOLUME_COUNT; ++i) t = min(t, intervals[i].x);
  for (int s = 0; s < SURFACE_COUNT; ++s) t = min(t, crossings[s]);

  // from event to event: the beginning or end of a volume, or the crossing of a surface or layer
  for (int guard = 0; guard < 4096 && transmittance > frame.termination && t < end; ++guard) {
    float next = NO_DEPTH;
    int surface = -1;
    bool inside = false;
    for (int i = 0; i < VOLUME_COUNT; ++i) {
      if (intervals[i].x > t) next = min(next, intervals[i].x);
      else if (intervals[i].y > t) {
        next = min(next, intervals[i].y);
        if (intervals[i].x < NO_DEPTH) inside = true;
      }
    }
    for (int s = 0; s < SURFACE_COUNT; ++s)
      if (crossings[s] <= next && crossings[s] < NO_DEPTH) {
        next = crossings[s];
        surface = s;
      }
    const bool at_layer = layer_at < NO_DEPTH && layer_at <= next;
    if (at_layer) {
      next = layer_at;
      surface = -1;
    }
    if (next >= NO_DEPTH) break;
    if (inside && next > t) march(t, next);
    t = max(t, next);
    shade_surface(0, surface, t);
    shade_surface(1, surface, t);
    shade_surface(2, surface, t);
    shade_surface(3, surface, t);
    shade_surface(4, surface, t);
    shade_surface(5, surface, t);
    shade_surface(6, surface, t);
    shade_surface(7, surface, t);
#ifdef HAS_LAYERS
    if (at_layer) {
      const vec4 c = layer_color(layer, at);
      color_sum += transmittance * c.rgb;
      surface_transmittance *= 1.0 - c.a;
      transmittance *= 1.0 - c.a;
      layer_at = layer_depth(++layer, at, end);
    }
#endif
    if (HALF_OPACITY_DEPTH != 0u && half_opacity_depth >= NO_DEPTH && transmittance <= 0.5) half_opacity_depth = t;
  }
  out_color = HALF_OPACITY_DEPTH != 0u ? half_opacity_output() : vec4(color_sum, 1.0 - transmittance);
}
