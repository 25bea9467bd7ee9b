// SPDX-License-Identifier: MIT
// Emission and absorption along the pixel's ray, in front of the opaque depth:
//   T(t) = S exp(-tau),  tau += sigma h per segment,  C += c (T_before - T_after),  S *= 1 - opacity at a surface
// Optical depth is summed, and the exponential is taken of the sum, so that rounding errors do not accumulate over many segments. A segment
// has the value at its middle. The last segment of an interval is the exact remainder; with jitter the first segment is shortened, too. A
// homogeneous region (empty, or of constant color and sigma) is one segment. The includer defines GRID_COUNT and VOLUME_COUNT
// (grids 0 .. VOLUME_COUNT - 1).
layout(constant_id = 1) const uint HAS_OPAQUE = 0;       // there is an opaque depth
layout(constant_id = 5) const uint GRID_MODES = 0;   // two bits per grid: 1: factor by gradient, 2: color by another grid,
layout(constant_id = 6) const uint COLOR_GRIDS = 0;  // four bits per grid: index of that grid
layout(constant_id = 7) const uint HAS_JITTER = 0;
layout(constant_id = 9) const uint HAS_FOG = 0;  // there is depth fog
layout(constant_id = 10) const uint HALF_OPACITY_DEPTH = 0;  // output: depth of half transmittance instead of a color

#include "shaders/lib/tables.glsl"
layout(binding = 2) uniform texture2D opaque_depth;
layout(location = 0) out vec4 out_color;  // premultiplied

LocalRay rays[GRID_COUNT];
vec2 intervals[GRID_COUNT];
vec3 view_direction;
float world_per_depth;
float jitter_offset = 0.0;  // missing part of the first segment, in segments
float optical_depth = 0.0, surface_transmittance = 1.0, transmittance = 1.0;
vec3 color_sum = vec3(0.0);
float half_opacity_depth = NO_DEPTH;
vec2 light_q;               // pixel coordinate
float light_is_on = 0.0;    // 1: things darken each other

bool has_factor(int i) { return (GRID_MODES >> (2 * i) & 1u) != 0u; }
bool has_other_color(int i) { return (GRID_MODES >> (2 * i) & 2u) != 0u; }

vec4 transfer(int i, float value) {
  uint at;
  float way;
  find_entry(frame.grids[i].value_table, value, at, way);
  const float sigma = mix(entry_sigma(at), entry_sigma(at + 1u), way);
  if (sigma == 0.0) return vec4(0.0);
  return vec4(mix(table[at].rgb, table[at + 1u].rgb, way), sigma);
}

// Returns the factor of sigma by gradient magnitude, in field units per world unit.
float gradient_factor(int i, float gradient) {
  uint at;
  float way;
  find_entry(frame.grids[i].gradient_table, gradient, at, way);
  return mix(table[at].r, table[at + 1u].r, way);
}

#if GRID_COUNT > 1
#include "shaders/lib/color_by.glsl"
// Returns the color of grid i at depth t by another grid, if it has one; else `own_color`.
vec3 resolve_color(int i, float t, vec3 own_color) {
  if (!has_other_color(i)) return own_color;
  const int j = int(COLOR_GRIDS >> (4 * i) & 15u);
  return color_at(j, rays[j].origin + t * rays[j].direction, own_color);
}
#else
vec3 resolve_color(int i, float t, vec3 own_color) { return own_color; }
#endif

// Adds volume i at depth t of its ray: sigma, and color * sigma. Reduces `skip_count` to the number of segments (of length h in depth) over
// which its contribution is constant. Call it with constant i only: loops over textures are not unrolled if they branch.
void add_volume(int i, float t, float h, inout vec3 emitted, inout float sigma_sum, inout int skip_count) {
  if (i < VOLUME_COUNT && (VOLUME_COUNT == 1 || (t >= intervals[i].x && t <= intervals[i].y))) {
    const vec3 p = clamp(rays[i].origin + t * rays[i].direction, frame.grids[i].lo, frame.grids[i].hi);
    int distance = 0;
    bool is_active = true;
    if (volume_skips(i)) {
      const ivec3 brick = cell_of(i, p) >> 3;
      const uint word = brick_word(i, brick);
      // fog and light vary in homogeneous regions
      distance = (HAS_FOG != 0u || light_is_on > 0.0) && is_homogeneous(word) ? 0 : skip_distance(word);
      is_active = distance == 0 || is_homogeneous(word);
      if (distance > 0) skip_count = min(skip_count, max(1, int(ceil(min(exit_empty_region(rays[i], p, brick, distance) / h, 1e6)))));
    }
    if (distance == 0) skip_count = 1;
    if (is_active) {
      bool valid = true;
      if (grid_is_masked(i)) valid = cell_is_valid(i, cell_of(i, p));
      if (valid) {
        vec4 c = transfer(i, sample_value(i, p));
        if (c.a > 0.0) {
          vec3 gradient = vec3(0.0);
          if (volume_is_shaded(i) || has_factor(i)) gradient = world_gradient(i, p);
          if (has_factor(i)) c.a *= gradient_factor(i, length(gradient) * frame.grids[i].value_scale);
          c.rgb = resolve_color(i, t, c.rgb);
          for (float on = light_is_on; on > 0.0; on = 0.0) {
            receive_in_volume(light_at(light_q, t));
            if (!volume_is_shaded(i)) c.rgb = lit(c.rgb, scattered_light(frame.grids[i].anisotropy, view_direction));
          }
          if (volume_is_shaded(i))
            c.rgb = lit(c.rgb, with_phase(lighting_of(gradient, view_direction), frame.grids[i].surface_share, frame.grids[i].anisotropy, view_direction));
          if (HAS_FOG != 0u) c.rgb = fogged(c.rgb, t);
          emitted += c.a * c.rgb;
          sigma_sum += c.a;
        }
      }
    }
  }
}

// Returns the position where transmittance falls to 0.5 in a segment of constant sigma, as a share of its length; before > 0.5 >= after.
float half_transmittance_position(float before, float after) { return clamp(log(2.0 * before) / log(before / max(after, 1e-30)), 0.0, 1.0); }

vec4 half_opacity_output() { return vec4(half_opacity_depth, 0.0, 0.0, half_opacity_depth < NO_DEPTH ? 1.0 : 0.0); }

// Marches [from, to] in segments of equal length; the set of volumes on the ray is constant in the interval.
void march(float from, float to) {
  const float h = frame.step_world / world_per_depth;
  const int count = max(1, int(ceil((to - from) / h + jitter_offset - 1e-3)));
  for (int k = 0; k < count && transmittance > frame.termination;) {
    float begin = from + float(k) * h, extent = h;
    if (HAS_JITTER != 0u) {
      begin = k == 0 ? from : begin - jitter_offset * h;
      extent = k == 0 ? (1.0 - jitter_offset) * h : h;
    }
    const float t = begin + 0.5 * (k == count - 1 ? to - begin : extent);
    int skip_count = count;
    vec3 emitted = vec3(0.0);
    float sigma_sum = 0.0;
    add_volume(0, t, h, emitted, sigma_sum, skip_count);
#if GRID_COUNT > 1
    add_volume(1, t, h, emitted, sigma_sum, skip_count);
    add_volume(2, t, h, emitted, sigma_sum, skip_count);
    add_volume(3, t, h, emitted, sigma_sum, skip_count);
#endif
    extent = k + skip_count >= count ? to - begin : extent + float(skip_count - 1) * h;
    k += skip_count;
    if (sigma_sum > 0.0) {
      optical_depth += sigma_sum * extent * world_per_depth;
      const float after = surface_transmittance * exp(-optical_depth);
      if (HALF_OPACITY_DEPTH != 0u && transmittance > 0.5 && after <= 0.5) half_opacity_depth = begin + extent * half_transmittance_position(transmittance, after);
      color_sum += emitted / sigma_sum * (transmittance - after);
      transmittance = after;
    }
  }
}

// Returns the visible interval of the ray in a grid's domain; NO_DEPTH twice if it is empty.
vec2 visible_ray_interval(int i, vec2 q, float end) {
  vec2 interval = visible_interval(i, rays[i], q);
  interval.y = min(interval.y, end);
  return interval.x < interval.y ? interval : vec2(NO_DEPTH);
}

// Initializes the pixel; returns the depth at which rays end.
float setup_pixel(vec2 q) {
  const vec3 direction = world_direction(q);
  world_per_depth = length(direction);
  view_direction = -direction / world_per_depth;
  light_q = q;
  light_is_on = max(frame.light_grid.is_on, frame.look.is_linear) + float(q.x < -1e30);  // not uniform, as in as_nonuniform (rays.glsl)
  // interleaved gradient noise (J. Jimenez, 2014): adjacent pixels differ strongly, so that the eye averages over them
  if (HAS_JITTER != 0u) jitter_offset = fract(52.9829189 * fract(dot(floor(q + frame.axis), vec2(0.06711056, 0.00583715))));
  return HAS_OPAQUE != 0u ? texelFetch(opaque_depth, ivec2(q + frame.axis), 0).r : NO_DEPTH;
}
