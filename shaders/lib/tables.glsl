// Transfer functions: r, g, b, sigma (per world unit), or in the first component a factor; piecewise linear.
layout(scalar, binding = 1) readonly buffer Tables { vec4 table[]; };

layout(constant_id = 11) const uint UNEVEN = 0;  // there is a table whose entries lie at values of their own, which follow them

float own_value(int i, uint entry) { return table[frame.grids[i].table_start + frame.grids[i].table_last + 1u + entry / 4u][entry % 4u]; }

// The value's place in the table of grid i: the entry, and the way to the next one.
float table_place(int i, float value) {
  if (UNEVEN != 0u && frame.grids[i].table_per_value < 0.0) {
    uint before = 0u, after = frame.grids[i].table_last;
    while (after - before > 1u) {
      const uint middle = (before + after) / 2u;
      if (own_value(i, middle) <= value)
        before = middle;
      else
        after = middle;
    }
    const float a = own_value(i, before), b = own_value(i, after);
    return float(before) + (b > a ? clamp((value - a) / (b - a), 0.0, 1.0) : 1.0);
  }
  return clamp((value - frame.grids[i].table_lo) * frame.grids[i].table_per_value, 0.0, float(frame.grids[i].table_last));
}
