// SPDX-License-Identifier: MIT
// Extremum of the value along a ray.
//   nearest     the corner weights are 0 or 1; the values at four points are compared
//   trilinear   the value is a cubic; its maximum lies at an end of the segment or at a root of the derivative
//   cubic       the value has degree nine; cubics through four of ten points predict its maximum, where the cell is evaluated
// Bricks without a better value than the best so far are skipped: bits 24..31 of a brick's word are 0 if it has no valid cell, else 1 + n,
// and no value in it is better than bound_lo + n bound_per_code. A minimum is computed as the maximum of -value.
float interpolate_cell(vec4 lo, vec4 hi, vec3 position) {
  if (grid_is_cubic(0)) return cubic_value(position);
  const vec3 f = corner_weights(0, position);
  const vec4 z = mix(lo, hi, f.z);
  const vec2 y = mix(z.xy, z.zw, f.y);
  return mix(y.x, y.y, f.x);
}

#include "shaders/lib/extremum.glsl"

// Returns the maximum of `best` and of a cubic cell's values from a to b; skips a cell whose bound does not exceed `best`.
float max_of_cubic(ivec3 cell, vec3 a, vec3 b, float best) {
  fetch_cubic(0, cell);
  const float offset = signed_value(frame.grids[0].value_offset), scale = signed_value(frame.grids[0].value_scale);
  vec4 low = vec4(NO_DEPTH), high = vec4(-NO_DEPTH);
  for (int row = 0; row < 16; ++row) {
    cubic_rows[row] = offset + scale * cubic_rows[row];
    low = min(low, cubic_rows[row]);
    high = max(high, cubic_rows[row]);
  }
  const float lowest = min(min(low.x, low.y), min(low.z, low.w)), highest = max(max(high.x, high.y), max(high.z, high.w));
  if (highest + CUBIC_OVERSHOOT * (highest - lowest) > best) {
    for (int part = 0; part < 3; ++part)
      best = max(best, max_between(vec4(0.0), vec4(0.0), mix(a, b, float(part) / 3.0), mix(a, b, float(part + 1) / 3.0)));
  }
  return best;
}

float find_extremum(LocalRay ray, vec2 interval) {
  const vec3 inverse = safe_inverse(ray.direction);
  const bvec3 forward = is_forward(ray.direction);
  const ivec3 first = ivec3(frame.grids[0].lo), last = ivec3(frame.grids[0].hi) - 1;
  float best = -NO_DEPTH;
  ivec3 cell = cell_of(0, ray.origin + interval.x * ray.direction);
  float t = interval.x;
  bool done = false;
  while (!done && t < interval.y) {
    const ivec3 brick = cell >> 3;
    const uint code = brick_word(0, brick) >> 24;
    const bool pass = code == 0u || frame.grids[0].bound_lo + float(code - 1u) * frame.grids[0].bound_per_code <= best;
    const ivec3 lo = pass ? brick * BRICK_SIZE : cell, hi = lo + (pass ? BRICK_SIZE : 1);
    const vec3 leave = (mix(vec3(lo), vec3(hi), forward) - ray.origin) * inverse;
    const float out_at = min(min(leave.x, leave.y), leave.z);
    if (!pass && cell_is_valid(0, cell)) {
      const vec3 a = clamp(ray.origin + t * ray.direction - vec3(cell), 0.0, 1.0);
      const vec3 b = clamp(ray.origin + clamp(out_at, t, interval.y) * ray.direction - vec3(cell), 0.0, 1.0);
      if (grid_is_cubic(0)) {
        best = max_of_cubic(cell, a, b, best);
      } else {
        vec4 low, high;
        cell_corners(0, cell, low, high);
        low = PROJECTION_KIND == 2u ? -low : low;
        high = PROJECTION_KIND == 2u ? -high : high;
        const vec4 maxima = max(low, high);
        if (max(max(maxima.x, maxima.y), max(maxima.z, maxima.w)) > best) best = max(best, max_between(low, high, a, b));
      }
    }
    // the cell behind the face through which the ray exits
    const bool x = leave.x == out_at, y = !x && leave.y == out_at;
    const ivec3 outside = ivec3(mix(vec3(lo - 1), vec3(hi), forward));
    ivec3 inside = cell;
    if (pass) inside = clamp(ivec3(floor(ray.origin + out_at * ray.direction)), lo, hi - 1);
    cell = ivec3(x ? outside.x : inside.x, y ? outside.y : inside.y, x || y ? inside.z : outside.z);
    t = max(t, out_at);
    done = any(lessThan(cell, first)) || any(greaterThan(cell, last));
  }
  return best > -NO_DEPTH ? signed_value(best) : NO_DEPTH;
}

// Returns whether the value at a position is valid.
bool value_at(vec3 p, out float value) {
  bool valid = true;
  value = 0.0;
  if (grid_is_masked(0)) valid = cell_is_valid(0, cell_of(0, p));
  if (valid) value = sample_value(0, p);
  return valid;
}
