// SPDX-License-Identifier: MIT
// Where the nearest voxel counts the weights of the corners are whole, and what stands at the four places is compared.
// In a trilinear cell the value along a ray is a cubic: its greatest value lies at an end of the segment or at a root of the derivative.
// In a cubic cell it is of ninth degree: a cubic through each four of ten places says where to look, and the cell itself is asked there.
// Bricks of which no value can be better than the best so far are passed over: bits 24..31 of a brick's word are 0 where it has no
// valid cell, else 1 + n, and no value in it is better than bound_lo + n bound_per_code. A minimum is the maximum of -value.
float signed_value(float v) { return PROJECTION_KIND == 2u ? -v : v; }

float interpolate_cell(vec4 lo, vec4 hi, vec3 place) {
  if (grid_is_cubic(0)) return cubic_value(place);
  const vec3 f = corner_weights(0, place);
  const vec4 z = mix(lo, hi, f.z);
  const vec2 y = mix(z.xy, z.zw, f.y);
  return mix(y.x, y.y, f.x);
}

// The greatest value of a cell with corners lo, hi between a and b.
float max_between(vec4 lo, vec4 hi, vec3 a, vec3 b) {
  const float f0 = interpolate_cell(lo, hi, a), f1 = interpolate_cell(lo, hi, mix(a, b, 1.0 / 3.0)), f2 = interpolate_cell(lo, hi, mix(a, b, 2.0 / 3.0)),
              f3 = interpolate_cell(lo, hi, b);
  float best = max(max(f0, f1), max(f2, f3));
  // derivative: c1 + 2 c2 u + 3 c3 u^2
  const float c1 = 0.5 * (-11.0 * f0 + 18.0 * f1 - 9.0 * f2 + 2.0 * f3);
  const float c2 = 4.5 * (2.0 * f0 - 5.0 * f1 + 4.0 * f2 - f3), c3 = 4.5 * (3.0 * (f1 - f2) + f3 - f0);
  const float discriminant = c2 * c2 - 3.0 * c1 * c3;
  if (discriminant >= 0.0) {
    const float w = -(c2 + (c2 >= 0.0 ? 1.0 : -1.0) * sqrt(discriminant));
    const float r0 = abs(c3) > 0.0 ? w / (3.0 * c3) : 0.0, r1 = abs(w) > 0.0 ? c1 / w : 0.0;
    best = max(best, max(interpolate_cell(lo, hi, mix(a, b, clamp(r0, 0.0, 1.0))), interpolate_cell(lo, hi, mix(a, b, clamp(r1, 0.0, 1.0)))));
  }
  return best;
}

// The same of a cubic cell; `best` where it cannot hold more.
float max_of_cubic(ivec3 cell, vec3 a, vec3 b, float best) {
  fetch_cubic(0, cell);
  const float offset = signed_value(frame.grids[0].value_offset), scale = signed_value(frame.grids[0].value_scale);
  vec4 low = vec4(NO_DEPTH), high = vec4(-NO_DEPTH);
  for (int row = 0; row < 16; ++row) {
    cubic_rows[row] = offset + scale * cubic_rows[row];
    low = min(low, cubic_rows[row]);
    high = max(high, cubic_rows[row]);
  }
  const float least = min(min(low.x, low.y), min(low.z, low.w)), greatest = max(max(high.x, high.y), max(high.z, high.w));
  if (greatest + CUBIC_OVERSHOOT * (greatest - least) > best) {
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
        const vec4 most = max(low, high);
        if (max(max(most.x, most.y), max(most.z, most.w)) > best) best = max(best, max_between(low, high, a, b));
      }
    }
    // the cell behind the face through which the ray leaves
    const bool x = leave.x == out_at, y = !x && leave.y == out_at;
    const ivec3 beyond = ivec3(mix(vec3(lo - 1), vec3(hi), forward));
    ivec3 inside = cell;
    if (pass) inside = clamp(ivec3(floor(ray.origin + out_at * ray.direction)), lo, hi - 1);
    cell = ivec3(x ? beyond.x : inside.x, y ? beyond.y : inside.y, x || y ? inside.z : beyond.z);
    t = max(t, out_at);
    done = any(lessThan(cell, first)) || any(greaterThan(cell, last));
  }
  return best > -NO_DEPTH ? signed_value(best) : NO_DEPTH;
}

float find_average(LocalRay ray, vec2 interval, float h) {
  const int count = max(1, int(ceil((interval.y - interval.x) / h - 1e-3)));
  float sum = 0.0, measured = 0.0;
  for (int k = 0; k < count; ++k) {
    const float begin = interval.x + float(k) * h, extent = k == count - 1 ? interval.y - begin : h;
    const vec3 p = clamp(ray.origin + (begin + 0.5 * extent) * ray.direction, frame.grids[0].lo, frame.grids[0].hi);
    bool valid = true;
    if (grid_is_masked(0)) valid = cell_is_valid(0, cell_of(0, p));
    if (valid) {
      sum += extent * sample_value(0, p);
      measured += extent;
    }
  }
  return measured > 0.0 ? sum / measured : NO_DEPTH;
}
