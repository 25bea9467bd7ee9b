// SPDX-License-Identifier: MIT
// Maximum of a cell's value along a segment of a ray; a minimum is that of -value. The includer defines interpolate_cell.
float signed_value(float v) { return PROJECTION_KIND == 2u ? -v : v; }

// Returns the maximum value of a cell with corners lo, hi on the segment from a to b.
float max_between(vec4 lo, vec4 hi, vec3 a, vec3 b) {
  const float f0 = interpolate_cell(lo, hi, a), f1 = interpolate_cell(lo, hi, mix(a, b, 1.0 / 3.0)), f2 = interpolate_cell(lo, hi, mix(a, b, 2.0 / 3.0)),
              f3 = interpolate_cell(lo, hi, b);
  float best = max(max(f0, f1), max(f2, f3));
  // coefficients of the derivative c1 + 2 c2 u + 3 c3 u^2
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
