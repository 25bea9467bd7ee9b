// SPDX-License-Identifier: MIT
#include "engine/io/volume/crop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/field/grid/dense.h"
#include "engine/io/formats.h"
#include "engine/io/volume/write_box.h"

namespace catena::field {
namespace {

/// A box of voxels, with indices relative to the lowest voxel of the complete grid.
struct Part {
  Index3 from, size;
};

template <class Grid>
Result<std::shared_ptr<const Grid>> part_of(const std::string& path, const VoxelBox& full, const Part& part) {
  DenseSource source;
  source.size = part.size;
  source.has_mask = full.has_mask;
  CATENA_CHECK(check_dense_memory(path, source.size, full.components, full.has_mask));
  std::vector<float> layer(full.layer_voxels() * static_cast<std::size_t>(full.components));
  std::vector<std::uint8_t> layer_valid(full.has_mask ? full.layer_voxels() : 0);
  source.read = [&](int first, int count, std::span<float> values, std::span<std::uint8_t> valid) -> Outcome {
    const auto row = static_cast<std::size_t>(part.size.x), components = static_cast<std::size_t>(full.components);
    std::size_t to = 0;
    for (int z = first; z < first + count; ++z) {
      full.read_values(part.from.z + z, layer);
      if (full.has_mask) full.read_valid(part.from.z + z, layer_valid);
      for (int y = 0; y < part.size.y; ++y, to += row) {
        const std::size_t at = static_cast<std::size_t>(part.from.y + y) * static_cast<std::size_t>(full.size.x) + part.from.x;
        std::copy_n(layer.begin() + static_cast<std::ptrdiff_t>(at * components), row * components,
                    values.begin() + static_cast<std::ptrdiff_t>(to * components));
        if (full.has_mask)
          std::copy_n(layer_valid.begin() + static_cast<std::ptrdiff_t>(at), row, valid.begin() + static_cast<std::ptrdiff_t>(to));
      }
    }
    return Done{};
  };
  if (full.has_cell_mask)
    source.read_cells = [&](int first, int count, std::span<std::uint8_t> cells) -> Outcome {
      const auto row = static_cast<std::size_t>(part.size.x);
      std::size_t to = 0;
      for (int z = first; z < first + count; ++z) {
        full.read_cells(part.from.z + z, layer_valid);
        for (int y = 0; y < part.size.y; ++y, to += row) {
          const std::size_t at = static_cast<std::size_t>(part.from.y + y) * static_cast<std::size_t>(full.size.x) + part.from.x;
          std::copy_n(layer_valid.begin() + static_cast<std::ptrdiff_t>(at), row, cells.begin() + static_cast<std::ptrdiff_t>(to));
        }
      }
      return Done{};
    };
  const Mapping mapping = Mapping::from_linear(full.mapping.world_from_index_linear,
                                               full.mapping.world_from_index(Vec3(part.from.x, part.from.y, part.from.z)));
  return make_dense_grid<Grid>(full.name, mapping, source, fmt::format("{}: within \"crop\" the grid \"{}\" ", path, full.name), true);
}

}  // namespace

ActiveBox voxels_in_box(const Box& world, const Mapping& mapping) {
  constexpr double kSlack = 1e-9;  // fraction of a voxel: a face that coincides with voxels needs no additional voxels
  Vec3 lo(std::numeric_limits<double>::infinity()), hi(-std::numeric_limits<double>::infinity());
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p = mapping.index_from_world(
        {corner & 1 ? world.hi.x : world.lo.x, corner & 2 ? world.hi.y : world.lo.y, corner & 4 ? world.hi.z : world.lo.z});
    for (int axis = 0; axis < 3; ++axis) lo[axis] = std::fmin(lo[axis], p[axis]), hi[axis] = std::fmax(hi[axis], p[axis]);
  }
  ActiveBox box;
  const auto index = [](double v) { return static_cast<std::int32_t>(std::clamp(v, -double(kMaxAbsIndex), double(kMaxAbsIndex))); };
  for (int axis = 0; axis < 3; ++axis) {
    const double slack = kSlack * std::fmax(1.0, std::fmax(std::fabs(lo[axis]), std::fabs(hi[axis])));
    box.lo[axis] = index(std::floor(lo[axis] + slack));
    box.hi[axis] = index(std::ceil(hi[axis] - slack));
  }
  return box;
}

Result<AnyField> crop_field(const std::string& path, const AnyField& field, const Box& world) {
  const VoxelBox full(field, field.get()->name(), {});
  const ActiveBox needed = voxels_in_box(world, full.mapping);
  const int n[3] = {full.size.x, full.size.y, full.size.z};
  int from[3], size[3];
  for (int axis = 0; axis < 3; ++axis) {
    from[axis] = std::max(0, needed.lo[axis]);
    size[axis] = std::min(n[axis] - 1, needed.hi[axis]) - from[axis] + 1;
    if (size[axis] < std::min(2, n[axis]))
      return Error{fmt::format("{}: \"crop\" contains no voxels of the grid \"{}\" along {}; a box that overlaps the data was expected",
                               path, full.name, "xyz"[axis])};
  }
  const Part part{{from[0], from[1], from[2]}, {size[0], size[1], size[2]}};
  AnyField result = field;
  if (field.scalar) {
    CATENA_TRY(result.scalar, part_of<ScalarGrid>(path, full, part));
  } else {
    CATENA_TRY(result.vector, part_of<VectorGrid>(path, full, part));
  }
  return result;
}

}  // namespace catena::field
