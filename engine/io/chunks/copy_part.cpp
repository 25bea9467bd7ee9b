// SPDX-License-Identifier: MIT
#include "engine/io/chunks/copy_part.h"

#include <algorithm>
#include <cstring>

namespace catena::chunks {
namespace {

template <class T>
void copy_rows(const ChunkView& chunk, const field::StoreBox& box, const int (&lo)[3], const int (&hi)[3], std::byte* out) {
  const std::ptrdiff_t row = box.size.x, layer = row * box.size.y;
  for (int z = lo[2]; z < hi[2]; ++z)
    for (int y = lo[1]; y < hi[1]; ++y) {
      const std::byte* from = chunk.first + chunk.stride[0] * (lo[0] - chunk.box.lo.x) + chunk.stride[1] * (y - chunk.box.lo.y) +
                              chunk.stride[2] * (z - chunk.box.lo.z);
      std::byte* to = out + ((z - box.lo.z) * layer + (y - box.lo.y) * row + (lo[0] - box.lo.x)) * std::ptrdiff_t{sizeof(T)};
      const int count = hi[0] - lo[0];
      if (chunk.stride[0] == std::ptrdiff_t{sizeof(T)}) {
        std::memcpy(to, from, static_cast<std::size_t>(count) * sizeof(T));
        continue;
      }
      for (int x = 0; x < count; ++x) std::memcpy(to + x * std::ptrdiff_t{sizeof(T)}, from + x * chunk.stride[0], sizeof(T));
    }
}

template <class T>
void swap_numbers(std::span<std::byte> values) {
  for (std::size_t at = 0; at + sizeof(T) <= values.size(); at += sizeof(T))
    std::reverse(values.begin() + static_cast<std::ptrdiff_t>(at), values.begin() + static_cast<std::ptrdiff_t>(at + sizeof(T)));
}

}  // namespace

void copy_part(const ChunkView& chunk, const field::StoreBox& box, std::size_t bytes, std::span<std::byte> values) {
  const int box_lo[3] = {box.lo.x, box.lo.y, box.lo.z}, box_size[3] = {box.size.x, box.size.y, box.size.z};
  const int own_lo[3] = {chunk.box.lo.x, chunk.box.lo.y, chunk.box.lo.z};
  const int own_size[3] = {chunk.box.size.x, chunk.box.size.y, chunk.box.size.z};
  int lo[3], hi[3];
  for (int a = 0; a < 3; ++a) {
    lo[a] = std::max(box_lo[a], own_lo[a]);
    hi[a] = std::min(box_lo[a] + box_size[a], own_lo[a] + own_size[a]);
    if (lo[a] >= hi[a]) return;
  }
  switch (bytes) {
    case 1:
      return copy_rows<std::uint8_t>(chunk, box, lo, hi, values.data());
    case 2:
      return copy_rows<std::uint16_t>(chunk, box, lo, hi, values.data());
    case 4:
      return copy_rows<std::uint32_t>(chunk, box, lo, hi, values.data());
    default:
      return copy_rows<std::uint64_t>(chunk, box, lo, hi, values.data());
  }
}

void swap_bytes(std::span<std::byte> values, std::size_t bytes) {
  if (bytes == 2) return swap_numbers<std::uint16_t>(values);
  if (bytes == 4) return swap_numbers<std::uint32_t>(values);
  if (bytes == 8) return swap_numbers<std::uint64_t>(values);
}

}  // namespace catena::chunks
