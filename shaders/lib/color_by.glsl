// Colours by another grid at the same world place. Grid j holds a table of colours; `p` is the place in its own index space.
vec3 color_at(int j, vec3 p, vec3 otherwise) {
  if (any(lessThan(p, frame.grids[j].domain_lo)) || any(greaterThan(p, frame.grids[j].domain_hi))) return otherwise;
  bool valid = true;
  if (grid_is_masked(j)) valid = cell_is_valid(j, cell_of(j, p));
  if (!valid) return otherwise;
  const float x = table_place(j, sample_value(j, p));
  const uint cell = min(uint(x), frame.grids[j].table_last - 1u);
  const uint at = frame.grids[j].table_start + cell;
  return mix(table[at].rgb, table[at + 1u].rgb, x - float(cell));
}
