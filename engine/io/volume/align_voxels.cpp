// SPDX-License-Identifier: MIT
// Reorders the voxels of a source whose axes lie along the world axes in another order or direction.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <memory>

#include "engine/io/volume/voxel_source.h"

namespace catena::field {
namespace {

/// For each world axis the index axis along it, and whether that one has the opposite direction.
struct AxisOrder {
  std::array<int, 3> axis{0, 1, 2};
  std::array<bool, 3> is_mirrored{};
};

std::array<int, 3> as_array(const Index3& n) { return {n.x, n.y, n.z}; }
Index3 as_index(const std::array<int, 3>& n) { return {n[0], n[1], n[2]}; }

/// Copies a box between the two orders; numbers have the size of T. `out_size`: along the world axes.
template <class T>
void reorder(const AxisOrder& order, std::span<const std::byte> in, const std::array<int, 3>& in_size, std::span<std::byte> out,
             const std::array<int, 3>& out_size) {
  const std::array<std::ptrdiff_t, 3> stride{1, in_size[0], static_cast<std::ptrdiff_t>(in_size[0]) * in_size[1]};
  std::array<std::ptrdiff_t, 3> step{};
  const T* first = reinterpret_cast<const T*>(in.data());
  for (int w = 0; w < 3; ++w) {
    step[w] = order.is_mirrored[w] ? -stride[order.axis[w]] : stride[order.axis[w]];
    if (order.is_mirrored[w]) first += stride[order.axis[w]] * (out_size[w] - 1);
  }
  T* to = reinterpret_cast<T*>(out.data());
  for (int z = 0; z < out_size[2]; ++z)
    for (int y = 0; y < out_size[1]; ++y)
      for (int x = 0; x < out_size[0]; ++x) *to++ = first[z * step[2] + y * step[1] + x * step[0]];
}

}  // namespace

Result<VoxelSource> align_to_world(VoxelSource source) {
  const Mat3& linear = source.mapping.world_from_index_linear;
  const std::array<int, 3> n = as_array(source.size);
  AxisOrder order;
  std::array<bool, 3> is_used{};
  Mat3 aligned(0.0);
  Vec3 origin = source.mapping.origin;
  bool is_same = true;
  for (int w = 0; w < 3; ++w) {
    int axis = 0;
    for (int a = 1; a < 3; ++a)
      if (std::fabs(linear[a][w]) > std::fabs(linear[axis][w])) axis = a;
    // the displacement that the other axes cause along this one, voxels
    constexpr double kMaxShift = 0.01;
    double shift = 0;
    for (int a = 0; a < 3; ++a)
      if (a != axis) shift += std::fabs(linear[a][w] / linear[axis][w]) * (n[a] - 1);
    if (!(shift <= kMaxShift) || is_used[axis])
      return Error{
          fmt::format("the axes are rotated or sheared, expected axes along the world axes: OME-Zarr 0.4 stores spacing and "
                      "position only (.vdb, .nrrd and .nii store any axes)")};
    is_used[axis] = true;
    order.axis[w] = axis;
    order.is_mirrored[w] = linear[axis][w] < 0;
    aligned[w][w] = std::fabs(linear[axis][w]);
    if (order.is_mirrored[w]) origin[w] += (n[axis] - 1) * linear[axis][w];
    is_same = is_same && axis == w && !order.is_mirrored[w];
  }
  source.mapping = Mapping::from_linear(aligned, origin);
  if (is_same) return source;
  const std::array<int, 3> group = as_array(source.bricks_at_once);
  source.size = {n[order.axis[0]], n[order.axis[1]], n[order.axis[2]]};
  source.bricks_at_once = {group[order.axis[0]], group[order.axis[1]], group[order.axis[2]]};
  source.is_empty = {};
  source.read = [order, n, bytes = source.type.bytes, read = source.read](const Index3& lo, const Index3& size,
                                                                          std::span<std::byte> values) -> Outcome {
    const std::array<int, 3> out_lo = as_array(lo), out_size = as_array(size);
    std::array<int, 3> in_lo{}, in_size{};
    for (int w = 0; w < 3; ++w) {
      const int a = order.axis[w];
      in_size[a] = out_size[w];
      in_lo[a] = order.is_mirrored[w] ? n[a] - out_lo[w] - out_size[w] : out_lo[w];
    }
    std::vector<std::byte> box(values.size());
    CATENA_CHECK(read(as_index(in_lo), as_index(in_size), box));
    if (bytes == 1) reorder<std::uint8_t>(order, box, in_size, values, out_size);
    if (bytes == 2) reorder<std::uint16_t>(order, box, in_size, values, out_size);
    if (bytes == 4) reorder<std::uint32_t>(order, box, in_size, values, out_size);
    if (bytes == 8) reorder<std::uint64_t>(order, box, in_size, values, out_size);
    return Done{};
  };
  return source;
}

}  // namespace catena::field
