#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// Emission and absorption along the pixel's ray, all volumes and translucent isosurfaces together, up to the opaque depth:
//   T(t) = S exp(-tau),  tau += sigma h per segment,  C += c (T_before - T_after),  S *= 1 - opacity at a surface
// Optical depth is summed and the exponential taken of the sum, so that rounding does not pile up over many segments. The value
// of a segment is the one at its middle. The ray is cut where a volume begins or ends and at surfaces; the last segment of a
// piece is its exact rest.
#include "shaders/shared/frame.h"
#define GRID_COUNT MAX_GRIDS
#include "shaders/lib/grids.glsl"
#include "shaders/lib/rays.glsl"
#include "shaders/lib/lighting.glsl"
#include "shaders/lib/surface.glsl"

layout(constant_id = 1) const int VOLUMES = 1;   // grids 0 .. VOLUMES - 1
layout(constant_id = 2) const int SURFACES = 0;  // the grids after them
layout(constant_id = 3) const uint OPAQUE = 0;   // there is an opaque depth

// r, g, b, sigma (per world unit), piecewise linear
layout(scalar, binding = 1) readonly buffer Tables { vec4 table[]; };
layout(binding = 2) uniform texture2D opaque_depth;
layout(location = 0) out vec4 out_color;  // premultiplied

LocalRay rays[MAX_GRIDS];
vec2 intervals[MAX_VOLUMES];
vec3 eye_direction;
float world_per_depth;
float optical_depth = 0.0, surfaces_through = 1.0, through = 1.0;
vec3 color_sum = vec3(0.0);

vec4 transfer(int i, float value) {
  const float x = clamp((value - frame.grids[i].table_lo) * frame.grids[i].table_per_value, 0.0, float(frame.grids[i].table_last));
  const uint cell = min(uint(x), frame.grids[i].table_last - 1u);
  const uint at = frame.grids[i].table_start + cell;
  const float f = x - float(cell);
  const float sigma = mix(table[at].a, table[at + 1u].a, f);
  if (sigma == 0.0) return vec4(0.0);
  return vec4(mix(table[at].rgb, table[at + 1u].rgb, f), sigma);
}

// What volume i adds at depth t of its ray: sigma and sigma-weighted colour. Lowers `leap` to the segments (of depth h) that may
// be passed over. Called with constants only: loops over textures are not unrolled once they branch.
void add_volume(int i, float t, float h, inout vec3 emitted, inout float sigma_sum, inout int leap) {
  if (i < VOLUMES && (VOLUMES == 1 || (t >= intervals[i].x && t <= intervals[i].y))) {
    const vec3 p = clamp(rays[i].origin + t * rays[i].direction, frame.grids[i].lo, frame.grids[i].hi);
    int empty = 0;
    ivec3 brick = ivec3(0);
    if (grid_skips(i)) {
      brick = cell_of(i, p) >> 3;
      empty = empty_distance(brick_word(i, brick));
    }
    if (empty > 0) {
      leap = min(leap, max(1, int(ceil(min(leave_empty(rays[i], p, brick, empty) / h, 1e6)))));
    } else {
      leap = 1;
      bool valid = true;
      if (grid_is_masked(i)) valid = cell_is_valid(i, cell_of(i, p));
      if (valid) {
        vec4 c = transfer(i, sample_value(i, p));
        if (c.a > 0.0) {
          if (grid_is_shaded(i)) c.rgb = lit(c.rgb, world_gradient(i, p), eye_direction);
          emitted += c.a * c.rgb;
          sigma_sum += c.a;
        }
      }
    }
  }
}

// Segments of one length over [from, to], in which the same volumes are met throughout.
void march(float from, float to) {
  const float h = frame.step_world / world_per_depth;
  const int count = max(1, int(ceil((to - from) / h - 1e-3)));
  for (int k = 0; k < count && through > frame.termination;) {
    const float begin = from + float(k) * h;
    const float extent = k == count - 1 ? to - begin : h;
    const float t = begin + 0.5 * extent;
    int leap = count;
    vec3 emitted = vec3(0.0);
    float sigma_sum = 0.0;
    add_volume(0, t, h, emitted, sigma_sum, leap);
    add_volume(1, t, h, emitted, sigma_sum, leap);
    add_volume(2, t, h, emitted, sigma_sum, leap);
    add_volume(3, t, h, emitted, sigma_sum, leap);
    k += leap;
    if (sigma_sum > 0.0) {
      optical_depth += sigma_sum * extent * world_per_depth;
      const float after = surfaces_through * exp(-optical_depth);
      color_sum += emitted / sigma_sum * (through - after);
      through = after;
    }
  }
}

// The surfaces, by their number, which is a constant here too.
float crossings[MAX_SURFACES];  // the next one
float limits[MAX_SURFACES];

void meet_surface(int s, vec2 q, float end) {
  const int i = VOLUMES + s;
  if (s < SURFACES) {
    rays[i] = local_ray(i, q);
    const vec2 interval = domain_interval(i, rays[i]);
    const float from = max(interval.x, frame.front);
    limits[s] = min(interval.y, end);
    crossings[s] = NO_DEPTH;
    if (from < limits[s]) crossings[s] = first_crossing(i, rays[i], from, limits[s]);
  }
}

// Blends surface s, if it is the one that the ray crosses at t, and looks for its next crossing a little way behind.
void pass_surface(int s, int surface, float t) {
  const int i = VOLUMES + s;
  if (s < SURFACES && s == surface && through > frame.termination) {
    const vec3 p = clamp(rays[i].origin + t * rays[i].direction, frame.grids[i].lo, frame.grids[i].hi);
    const float opacity = frame.grids[i].opacity;
    color_sum += through * opacity * lit(frame.grids[i].color, world_gradient(i, p), eye_direction);
    surfaces_through *= 1.0 - opacity;
    through *= 1.0 - opacity;
    const float past = t + 1e-3 / max(max(abs(rays[i].direction.x), abs(rays[i].direction.y)), abs(rays[i].direction.z));
    crossings[s] = NO_DEPTH;
    if (past < limits[s]) crossings[s] = first_crossing(i, rays[i], past, limits[s]);
  }
}

void main() {
  const vec2 q = pixel_place();
  const vec3 direction = world_direction(q);
  world_per_depth = length(direction);
  eye_direction = -direction / world_per_depth;
  float end = NO_DEPTH;
  if (OPAQUE != 0u) end = texelFetch(opaque_depth, ivec2(gl_FragCoord.xy), 0).r;

  // where the ray meets each grid
  float start = end;
  float last = frame.front;
  for (int i = 0; i < VOLUMES; ++i) {
    rays[i] = local_ray(i, q);
    vec2 interval = domain_interval(i, rays[i]);
    interval.x = max(interval.x, frame.front);
    interval.y = min(interval.y, end);
    if (!(interval.x < interval.y)) interval = vec2(NO_DEPTH);
    intervals[i] = interval;
    start = min(start, interval.x);
    if (interval.y < NO_DEPTH) last = max(last, interval.y);
  }
  if (SURFACES == 0 && VOLUMES == 1) {
    if (start < last) march(start, last);
    out_color = vec4(color_sum, 1.0 - through);
    return;
  }

  // the first crossing of each surface
  meet_surface(0, q, end);
  meet_surface(1, q, end);
  meet_surface(2, q, end);
  meet_surface(3, q, end);
  for (int s = 0; s < SURFACES; ++s) start = min(start, crossings[s]);

  // from event to event: a volume begins or ends, a surface is crossed
  float t = start;
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
