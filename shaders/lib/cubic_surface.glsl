// SPDX-License-Identifier: MIT
// First crossing of a level along a ray in a cubic cell, where the value is a polynomial of degree nine. It is evaluated at ten points; a
// cubic through four consecutive points predicts the position of a root, which is verified by the polynomial itself. Missed are pairs of
// roots between two of the points, if the polynomial exceeds the level there by less than the error of the cubic. Watertight: the value at
// the exit of a cell is reused as the value at the entry of the next.
#define CUBIC_SUBDIVISIONS 3

// Fetches the cell, with values relative to the level.
void fetch_level_cubic(int i, ivec3 cell) {
  fetch_cubic(i, cell);
  const float base = frame.grids[i].value_offset - frame.grids[i].level, scale = frame.grids[i].value_scale;
  for (int row = 0; row < 16; ++row) cubic_rows[row] = base + scale * cubic_rows[row];
}

float value_along(RaySegment segment, float u) { return cubic_value(mix(segment.a, segment.b, u)); }

// Returns the Bernstein coefficients of the cubic through values at 0, 1/3, 2/3 and 1.
vec4 cubic_through(vec4 v) {
  return vec4(v.x, (-5.0 * v.x + 18.0 * v.y - 9.0 * v.z + 2.0 * v.w) / 6.0, (2.0 * v.x - 9.0 * v.y + 18.0 * v.z - 5.0 * v.w) / 6.0, v.w);
}

bool signs_differ(float a, float b) { return (a >= 0.0) != (b >= 0.0); }

// Finds the first change of sign of the fetched cell along a segment. `value`: at its start on input, at its end on output.
bool find_sign_change(RaySegment segment, inout float value, out Bracket change) {
  bool found = false;
  change = Bracket(0.0, 0.0, 0.0, 1.0);
  for (int part = 0; part < CUBIC_SUBDIVISIONS && !found; ++part) {
    const float begin = float(part) / float(CUBIC_SUBDIVISIONS), extent = 1.0 / float(CUBIC_SUBDIVISIONS), third = extent / 3.0;
    const vec4 v = vec4(value, value_along(segment, begin + third), value_along(segment, begin + 2.0 * third), value_along(segment, begin + extent));
    Bracket near;
    if (first_bracket(cubic_through(v), near)) {
      change = Bracket(begin + extent * near.a, begin + extent * near.b, v.x, v.w);
      if (near.a > 0.0) change.fa = value_along(segment, change.a);
      if (near.b < 1.0) change.fb = value_along(segment, change.b);
      found = signs_differ(change.fa, change.fb);
    }
    if (!found && (signs_differ(v.x, v.y) || signs_differ(v.y, v.z) || signs_differ(v.z, v.w))) {
      found = true;
      change = Bracket(begin + 2.0 * third, begin + extent, v.z, v.w);
      if (signs_differ(v.y, v.z)) change = Bracket(begin + third, begin + 2.0 * third, v.y, v.z);
      if (signs_differ(v.x, v.y)) change = Bracket(begin, begin + third, v.x, v.y);
    }
    value = v.w;
  }
  return found;
}

// Returns the root of the fetched cell in the bracket, by the false position method with the Illinois rule.
float cubic_root(RaySegment segment, Bracket change) {
  float a = change.a, b = change.b, fa = change.fa, fb = change.fb, u = a, moved = 1.0;
  for (int k = 0; k < 24 && moved > 1e-7; ++k) {
    const float next = fb == fa ? 0.5 * (a + b) : clamp(a - fa * (b - a) / (fb - fa), min(a, b), max(a, b));
    const float f = value_along(segment, next);
    moved = abs(next - u);
    u = next;
    if (signs_differ(f, fb)) {
      a = b;
      fa = fb;
    } else {
      fa *= 0.5;
    }
    b = next;
    fb = f;
  }
  return u;
}

float first_cubic_crossing(int i, CellTraversal traversal, FlippedRay flipped, float to) {
  bool found = false;
  RaySegment segment = RaySegment(vec3(0.0), vec3(0.0), -NO_DEPTH, -NO_DEPTH);
  Bracket change = Bracket(0.0, 0.0, 0.0, 1.0);
  float value = 0.0;  // at the exit of the previous cell
  while (!found && traversal.t < to) {
    if (next_cell_in_map(i, traversal, flipped, to)) {
      fetch_level_cubic(i, traversal.cell ^ flipped.turned);
      const bool is_contiguous = traversal.t == segment.to;
      segment = segment_in_cell(traversal, flipped, to);
      if (!is_contiguous) value = value_along(segment, 0.0);
      found = find_sign_change(segment, value, change);
      advance_past(traversal, flipped, traversal.cell + 1);
    }
  }
  return found ? mix(segment.from, segment.to, cubic_root(segment, change)) : NO_DEPTH;
}
