// SPDX-License-Identifier: MIT
// Transfer functions, piecewise linear: r, g, b, sigma (per world unit), or a factor in the first component. A table holds samples that are
// evenly spaced on its scale, then the function's control points, and the values of these points, four per entry
// (render/raycast/transfer_tables.h). A negative sigma of a sample marks an interval where interpolation of the samples is inaccurate;
// there the control points are used.
layout(scalar, binding = 1) readonly buffer Tables { vec4 table[]; };

layout(constant_id = 11) const uint TABLE_FLAGS = 0;  // 1: control points exist, 2: nonlinear scales exist

float control_point_value(TableData of, uint point) { return table[of.start + of.last + 1u + of.control_points + point / 4u][point % 4u]; }

// Returns a value's coordinate on the table's scale.
float to_table_scale(TableData of, float value) {
  const float ratio = abs(value) * of.per_linear;
  const float position = sign(value) * (min(ratio, 1.0) + log(max(ratio, 1.0)));
  return of.per_linear > 0.0 ? position : value;
}

// Finds the entry before a value and the interpolation weight of the next one.
void find_entry(TableData of, float value, out uint at, out float way) {
  const float position = (TABLE_FLAGS & 2u) != 0u ? to_table_scale(of, value) : value;
  const float x = clamp((position - of.lo) * of.entries_per_unit, 0.0, float(of.last));
  const uint cell = min(uint(x), of.last - 1u);
  at = of.start + cell;
  way = x - float(cell);
  if ((TABLE_FLAGS & 1u) != 0u) {
    const bool marked = floatBitsToUint(table[at].a) >> 31 != 0u;
    uint before = 0u, after = marked ? of.control_points - 1u : 1u;
    float a = of.first_value, b = of.last_value;
    while (after - before > 1u) {
      const uint middle = (before + after) / 2u;
      const float at_middle = control_point_value(of, middle);
      const bool above = at_middle <= value;
      before = above ? middle : before;
      after = above ? after : middle;
      a = above ? at_middle : a;
      b = above ? b : at_middle;
    }
    at = marked ? of.start + of.last + 1u + before : at;
    way = marked ? clamp((value - a) / (b - a), 0.0, 1.0) : way;
  }
}

// Returns sigma without the mark.
float entry_sigma(uint at) { return (TABLE_FLAGS & 1u) != 0u ? abs(table[at].a) : table[at].a; }
vec4 interpolate_entry(uint at, float way) { return vec4(mix(table[at].rgb, table[at + 1u].rgb, way), mix(entry_sigma(at), entry_sigma(at + 1u), way)); }
