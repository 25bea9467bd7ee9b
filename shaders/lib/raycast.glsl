// Emission and absorption along the pixel's ray, in front of the opaque depth:
//   T(t) = S exp(-tau),  tau += sigma h per segment,  C += c (T_before - T_after),  S *= 1 - opacity at a surface
// Optical depth is summed and the exponential taken of the sum, so that rounding does not pile up over many segments. The value
// of a segment is the one at its middle; the last segment of a piece is its exact rest. The includer defines VOLUMES (grids
// 0 .. VOLUMES - 1) and GRID_COUNT.
layout(constant_id = 1) const uint OPAQUE = 0;  // there is an opaque depth

// r, g, b, sigma (per world unit), piecewise linear
layout(scalar, binding = 1) readonly buffer Tables { vec4 table[]; };
layout(binding = 2) uniform texture2D opaque_depth;
layout(location = 0) out vec4 out_color;  // premultiplied

LocalRay rays[GRID_COUNT];
vec2 intervals[GRID_COUNT];
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
          emitted += c.a * fogged(c.rgb, t);
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
#if GRID_COUNT > 1
    add_volume(1, t, h, emitted, sigma_sum, leap);
    add_volume(2, t, h, emitted, sigma_sum, leap);
    add_volume(3, t, h, emitted, sigma_sum, leap);
#endif
    k += leap;
    if (sigma_sum > 0.0) {
      optical_depth += sigma_sum * extent * world_per_depth;
      const float after = surfaces_through * exp(-optical_depth);
      color_sum += emitted / sigma_sum * (through - after);
      through = after;
    }
  }
}

// The part of a grid's domain that the ray sees; NO_DEPTH twice where there is none.
vec2 seen_interval(int i, vec2 q, float end) {
  vec2 interval = visible_interval(i, rays[i], q);
  interval.y = min(interval.y, end);
  return interval.x < interval.y ? interval : vec2(NO_DEPTH);
}

// Sets up the pixel; the depth where rays end.
float begin_pixel(vec2 q) {
  const vec3 direction = world_direction(q);
  world_per_depth = length(direction);
  eye_direction = -direction / world_per_depth;
  return OPAQUE != 0u ? texelFetch(opaque_depth, ivec2(q + frame.axis), 0).r : NO_DEPTH;
}
