#include "render/passes/color_grid.h"

#include <algorithm>

namespace catena::render {

BrickRange range_of(const GridMirror& mirror) {
  BrickRange all;
  for (const BrickRange& r : mirror.ranges) {
    if (r.empty()) continue;
    all = all.empty() ? r : BrickRange{std::min(all.least, r.least), std::max(all.greatest, r.greatest)};
  }
  return all.empty() ? BrickRange{0, 0} : all;
}

void set_table(shared::GridData& data, const TransferLut& lut, std::uint32_t start) {
  data.table_start = start;
  data.table_last = lut.last();
  data.table_lo = lut.lo;
  data.table_per_value = lut.per_value;
}

Result<bool> ColorGrid::update(vk::Device& device, std::shared_ptr<const GridMirror> next_mirror, const ColorSource& next) {
  const bool same_grid = mirror == next_mirror && map.image;
  if (same_grid && source.colors == next.colors) return false;
  mirror = std::move(next_mirror);
  source = next;
  lut = make_transfer_lut({next.colors, {}, {}, 0}, range_of(*mirror));
  if (!same_grid) {
    CATENA_TRY(map, make_word_map(device, *mirror, std::vector<std::uint8_t>(mirror->ranges.size())));
  }
  return true;
}

}  // namespace catena::render
