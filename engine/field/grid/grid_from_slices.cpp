// SPDX-License-Identifier: MIT
#include "engine/field/grid/grid_from_slices.h"

#include <fmt/format.h>

#include "engine/field/grid/dense.h"

namespace catena::field {
namespace {

constexpr int kMaxVoxels = 65536;  // per axis

template <class Grid>
Result<AnyField> grid_of(const std::string& name, const Mapping& mapping, const DenseSource& source) {
  CATENA_TRY(std::shared_ptr<const Grid> grid, make_dense_grid<Grid>(name, mapping, source, name + ": "));
  AnyField field;
  if constexpr (std::is_same_v<Grid, ScalarGrid>)
    field.scalar = std::move(grid);
  else
    field.vector = std::move(grid);
  return field;
}

}  // namespace

Result<AnyField> make_grid_from_slices(std::string name, const Mapping& mapping, const SliceSource& layers) {
  const Index3& size = layers.size;
  if (std::min({size.x, size.y, size.z}) < 2 || std::max({size.x, size.y, size.z}) > kMaxVoxels)
    return Error{
        fmt::format("{}: has {} x {} x {} voxels; from 2 to {} along each axis were expected", name, size.x, size.y, size.z, kMaxVoxels)};
  if (!mapping.is_invertible())
    return Error{name + ": the transform from voxels to the world cannot be inverted; a regular matrix was expected"};
  CATENA_CHECK(check_dense_memory(name, size, layers.is_vector ? 3 : 1, false));
  const DenseSource source{size, false, [&](int z, int, std::span<float> out, std::span<std::uint8_t>) -> Outcome {
                             layers.read(z, out);
                             return Done{};
                           }};
  return layers.is_vector ? grid_of<VectorGrid>(name, mapping, source) : grid_of<ScalarGrid>(name, mapping, source);
}

}  // namespace catena::field
