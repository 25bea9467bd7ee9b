// SPDX-License-Identifier: MIT
// Color of a pixel from the projection of the values along its ray. The includer defines find_extremum, value_at and field_value.

// Returns the mean of the values at the middles of segments of length h; NO_DEPTH: no value.
float find_average(LocalRay ray, vec2 interval, float h) {
  const int count = max(1, int(ceil((interval.y - interval.x) / h - 1e-3)));
  float sum = 0.0, measured = 0.0, value;
  for (int k = 0; k < count; ++k) {
    const float begin = interval.x + float(k) * h, extent = k == count - 1 ? interval.y - begin : h;
    if (value_at(clamp(ray.origin + (begin + 0.5 * extent) * ray.direction, frame.grids[0].lo, frame.grids[0].hi), value)) {
      sum += extent * value;
      measured += extent;
    }
  }
  return measured > 0.0 ? sum / measured : NO_DEPTH;
}

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
    find_entry(frame.grids[0].value_table, field_value(value), at, way);
    vec4 c = interpolate_entry(at, way);
    c.a = 1.0 - exp(-c.a * frame.grids[0].opacity);
    out_color = vec4(c.a * c.rgb, c.a);
  }
}
