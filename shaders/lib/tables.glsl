// Transfer functions: r, g, b, sigma (per world unit), or in the first component a factor; piecewise linear.
layout(scalar, binding = 1) readonly buffer Tables { vec4 table[]; };

// The value's place in the table of grid i: the entry, and the way to the next one.
float table_place(int i, float value) {
  return clamp((value - frame.grids[i].table_lo) * frame.grids[i].table_per_value, 0.0, float(frame.grids[i].table_last));
}
