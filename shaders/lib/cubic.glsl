// SPDX-License-Identifier: MIT
// Cubic cell (engine/field/cubic.h): the 4 x 4 x 4 texels around a cell of a padded resident grid (render/residency/resident_grid.h).
// Summed as differences from the texel at the cell's corner, so that equal texels give exactly their value and a gradient of 0.
#define CUBIC_OVERSHOOT (61.0 / 128.0)  // share of the texels' range, at both ends

vec4 cubic_rows[16];  // texels of the last fetched cell: rows along x, index y + 4 z

void fetch_cubic(int i, ivec3 cell) {
  for (int row = 0; row < 16; ++row) {
    const ivec3 at = cell + ivec3(-1, (row & 3) - 1, (row >> 2) - 1);
    cubic_rows[row] = vec4(texel(i, at), texel(i, at + ivec3(1, 0, 0)), texel(i, at + ivec3(2, 0, 0)), texel(i, at + ivec3(3, 0, 0)));
  }
}

// Weights of the texels 0, 2, 3, relative to texel 1: of the value and of its derivative.
vec3 cubic_weights(float t) { return 0.5 * vec3(t * (t * (2.0 - t) - 1.0), t * (1.0 + t * (4.0 - 3.0 * t)), t * t * (t - 1.0)); }
vec3 cubic_slopes(float t) { return 0.5 * vec3(t * (4.0 - 3.0 * t) - 1.0, 1.0 + t * (8.0 - 9.0 * t), t * (3.0 * t - 2.0)); }

vec4 weigh_rows(vec4 a, vec4 b, vec4 c, vec4 d, vec3 w) { return w.x * (a - b) + w.y * (c - b) + w.z * (d - b); }
float weigh_row(vec4 r, vec3 w) { return w.x * (r.x - r.y) + w.y * (r.z - r.y) + w.z * (r.w - r.y); }

// Returns the value at position f of the cell, each coordinate in 0..1.
float cubic_value(vec3 f) {
  const vec3 wx = cubic_weights(f.x), wy = cubic_weights(f.y), wz = cubic_weights(f.z);
  vec4 plane[4];
  for (int k = 0; k < 4; ++k) {
    const int r = 4 * k;
    plane[k] = cubic_rows[r + 1] + weigh_rows(cubic_rows[r], cubic_rows[r + 1], cubic_rows[r + 2], cubic_rows[r + 3], wy);
  }
  const vec4 row = plane[1] + weigh_rows(plane[0], plane[1], plane[2], plane[3], wz);
  return row.y + weigh_row(row, wx);
}

// Returns the value and its gradient, in local axes.
float cubic_value(vec3 f, out vec3 gradient) {
  const vec3 wx = cubic_weights(f.x), wy = cubic_weights(f.y), wz = cubic_weights(f.z), sy = cubic_slopes(f.y);
  vec4 plane[4], plane_y[4];
  for (int k = 0; k < 4; ++k) {
    const int r = 4 * k;
    plane[k] = cubic_rows[r + 1] + weigh_rows(cubic_rows[r], cubic_rows[r + 1], cubic_rows[r + 2], cubic_rows[r + 3], wy);
    plane_y[k] = weigh_rows(cubic_rows[r], cubic_rows[r + 1], cubic_rows[r + 2], cubic_rows[r + 3], sy);
  }
  const vec4 row = plane[1] + weigh_rows(plane[0], plane[1], plane[2], plane[3], wz);
  const vec4 row_y = plane_y[1] + weigh_rows(plane_y[0], plane_y[1], plane_y[2], plane_y[3], wz);
  const vec4 row_z = weigh_rows(plane[0], plane[1], plane[2], plane[3], cubic_slopes(f.z));
  gradient = vec3(weigh_row(row, cubic_slopes(f.x)), row_y.y + weigh_row(row_y, wx), row_z.y + weigh_row(row_z, wx));
  return row.y + weigh_row(row, wx);
}

// Fetches the cell that contains a local position of the domain; returns the position in it, 0..1.
vec3 fetch_cubic_at(int i, vec3 p) {
  const ivec3 cell = cell_of(i, p);
  fetch_cubic(i, cell);
  return clamp(p - vec3(cell), 0.0, 1.0);
}
