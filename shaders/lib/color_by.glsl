// SPDX-License-Identifier: MIT
// Color by another grid at the same world position. Grid j has a table of colors; `p` is the position in its index space.

// Returns the color of a value; alpha 0: the value has no color (it is no label), else 1.
vec4 table_color(int j, float value) {
  uint at;
  float way;
  find_entry(frame.grids[j].value_table, value, at, way);
  return interpolate_entry(at, way);
}

// Returns the color of the cell's nearest corner that has one; else `otherwise`.
vec3 nearest_label_color(int j, vec3 p, vec3 otherwise) {
  const ivec3 cell = cell_of(j, p);
  vec4 lo, hi;
  cell_corners(j, cell, lo, hi);
  const float values[8] = float[8](lo.x, lo.y, lo.z, lo.w, hi.x, hi.y, hi.z, hi.w);
  float best = NO_DEPTH;
  vec3 result = otherwise;
  for (int n = 0; n < 8; ++n) {
    const vec3 way = p - vec3(cell + ivec3(n & 1, n >> 1 & 1, n >> 2));
    const float distance2 = dot(way, way);
    const vec4 color = table_color(j, values[n]);
    if (color.a > 0.5 && distance2 < best) {
      best = distance2;
      result = color.rgb;
    }
  }
  return result;
}

vec3 color_at(int j, vec3 p, vec3 otherwise) {
  if (any(lessThan(p, frame.grids[j].domain_lo)) || any(greaterThan(p, frame.grids[j].domain_hi))) return otherwise;
  bool valid = true;
  if (grid_is_masked(j)) valid = cell_is_valid(j, cell_of(j, p));
  if (!valid) return otherwise;
  const vec4 color = table_color(j, sample_value(j, p));
  vec3 result = color.a > 0.5 ? color.rgb : otherwise;
  if (color.a < frame.grids[j].spread_labels) result = nearest_label_color(j, p, otherwise);
  return result;
}
