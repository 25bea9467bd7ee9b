// Volumes, translucent isosurfaces and layers together: the ray is cut where a volume begins or ends, at surfaces and at layers. The
// includer defines GRID_COUNT and, with layers, HAS_LAYERS.
layout(constant_id = 2) const int VOLUMES = 1;   // grids 0 .. VOLUMES - 1
layout(constant_id = 3) const int SURFACES = 0;  // the grids after them
layout(constant_id = 8) const int COLOR_GRID_COUNT = 0;  // and after those
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
    color_sum += through * opacity * fogged(lit(own_or_other(i, t, frame.grids[i].color), world_gradient(i, p), eye_direction), t);
    surfaces_through *= 1.0 - opacity;
    through *= 1.0 - opacity;
    const float past = t + 1e-3 / max(max(abs(rays[i].direction.x), abs(rays[i].direction.y)), abs(rays[i].direction.z));
    crossings[s] = NO_DEPTH;
    if (past < limits[s]) crossings[s] = first_crossing(i, rays[i], past, limits[s]);
  }
}

#ifndef HAS_LAYERS
float layer_depth(int k, ivec2 at, float end) { return NO_DEPTH; }
#endif

void main() {
  const vec2 q = pixel_place();
  const float end = begin_pixel(q);

  // where the ray meets each grid
  for (int j = VOLUMES + SURFACES; j < VOLUMES + SURFACES + COLOR_GRID_COUNT; ++j) rays[j] = local_ray(j, q);
  for (int i = 0; i < VOLUMES; ++i) {
    rays[i] = local_ray(i, q);
    intervals[i] = seen_interval(i, q, end);
  }
  meet_surface(0, q, end);
  meet_surface(1, q, end);
  meet_surface(2, q, end);
  meet_surface(3, q, end);
  meet_surface(4, q, end);
  meet_surface(5, q, end);
  meet_surface(6, q, end);
  meet_surface(7, q, end);
  const ivec2 at = ivec2(q + frame.axis);
  int layer = 0;
  float layer_at = layer_depth(0, at, end);
  float t = layer_at;
  for (int i = 0; i < VOLUMES; ++i) t = min(t, intervals[i].x);
  for (int s = 0; s < SURFACES; ++s) t = min(t, crossings[s]);

  // from event to event: a volume begins or ends, a surface or a layer is crossed
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
    const bool at_layer = layer_at < NO_DEPTH && layer_at <= next;
    if (at_layer) {
      next = layer_at;
      surface = -1;
    }
    if (next >= NO_DEPTH) break;
    if (inside && next > t) march(t, next);
    t = max(t, next);
    pass_surface(0, surface, t);
    pass_surface(1, surface, t);
    pass_surface(2, surface, t);
    pass_surface(3, surface, t);
    pass_surface(4, surface, t);
    pass_surface(5, surface, t);
    pass_surface(6, surface, t);
    pass_surface(7, surface, t);
#ifdef HAS_LAYERS
    if (at_layer) {
      const vec4 c = layer_color(layer, at);
      color_sum += through * c.rgb;
      surfaces_through *= 1.0 - c.a;
      through *= 1.0 - c.a;
      layer_at = layer_depth(++layer, at, end);
    }
#endif
    if (HALF_DEPTH != 0u && half_depth >= NO_DEPTH && through <= 0.5) half_depth = t;
  }
  out_color = HALF_DEPTH != 0u ? found_depth() : vec4(color_sum, 1.0 - through);
}
