// SPDX-License-Identifier: MIT
#include "engine/io/volume/transform.h"

#include <fmt/format.h>

#include "engine/base/memory_limit.h"
#include "engine/field/bricks/paged_grid.h"
#include "engine/field/grid/dense.h"
#include "engine/io/volume/write_box.h"

namespace catena::field {
namespace {

AffineMap as_map(const Mapping& mapping) { return {mapping.world_from_index_linear, mapping.origin}; }

/// Returns the map from voxel indices to the millimeters of flirt.
AffineMap flirt_from_index(const Mapping& mapping, const Size3& size) {
  const Mat3& j = mapping.world_from_index_linear;
  AffineMap map{Mat3(0.0), Vec3(0.0)};
  for (int a = 0; a < 3; ++a) map.linear[a][a] = norm(j[a]);
  if (glm::determinant(j) > 0) {
    map.offset.x = static_cast<double>(size.x - 1) * map.linear[0][0];
    map.linear[0][0] = -map.linear[0][0];
  }
  return map;
}

/// Returns a grid of the vectors multiplied by a matrix.
Result<VectorFieldPtr> turn_vectors(const std::string& path, const AnyField& field, const Mapping& mapping, const Mat3& linear) {
  const VoxelBox box(field, field.get()->name(), {});
  CATENA_CHECK(check_dense_memory(path, box.size, 3, box.has_mask));
  DenseSource source;
  source.size = box.size;
  source.has_mask = box.has_mask;
  const auto each_layer = [&box](int first, int count, auto out, std::size_t numbers, auto&& read) {
    for (int z = 0; z < count; ++z) read(first + z, out.subspan(static_cast<std::size_t>(z) * numbers, numbers));
  };
  source.read = [&](int first, int count, std::span<float> values, std::span<std::uint8_t> valid) -> Outcome {
    each_layer(first, count, values, 3 * box.layer_voxels(), [&](int z, std::span<float> out) { box.read_values(z, out); });
    for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
      const Vec3 v = linear * Vec3(values[i], values[i + 1], values[i + 2]);
      for (int c = 0; c < 3; ++c) values[i + static_cast<std::size_t>(c)] = static_cast<float>(v[c]);
    }
    if (box.has_mask)
      each_layer(first, count, valid, box.layer_voxels(), [&](int z, std::span<std::uint8_t> out) { box.read_valid(z, out); });
    return Done{};
  };
  if (box.has_cell_mask)
    source.read_cells = [&](int first, int count, std::span<std::uint8_t> cells) -> Outcome {
      each_layer(first, count, cells, box.layer_voxels(), [&](int z, std::span<std::uint8_t> out) { box.read_cells(z, out); });
      return Done{};
    };
  const Mapping from_first = Mapping::from_linear(mapping.world_from_index_linear, mapping.world_from_index(field.get()->index_box().lo));
  CATENA_TRY(auto grid, make_dense_grid<VectorGrid>(box.name, from_first, source, path + ": "));
  return VectorFieldPtr(std::move(grid));
}

}  // namespace

Result<AffineMap> world_map_of_flirt(const AffineMap& matrix, const Mapping& moving, const Size3& size, const std::string& reference) {
  CATENA_TRY(const std::vector<GridInfo> grids, describe_grids(reference));
  if (grids.empty()) return Error{reference + ": no grid was found, expected the reference image of the transform"};
  const AffineMap to_reference = as_map(grids.front().mapping).after(flirt_from_index(grids.front().mapping, grids.front().size).inverse());
  return to_reference.after(matrix).after(flirt_from_index(moving, size)).after(as_map(moving).inverse());
}

Result<AnyField> transform_field(const std::string& path, AnyField field, const FieldTransform& transform) {
  const Field& any = *field.get();
  AffineMap map = transform.map;
  if (!transform.flirt_reference.empty()) {
    const Vec3 last = any.index_box().hi - any.index_box().lo;
    const Size3 size(std::llround(last.x) + 1, std::llround(last.y) + 1, std::llround(last.z) + 1);
    const Mapping from_first =
        Mapping::from_linear(any.mapping().world_from_index_linear, any.mapping().world_from_index(any.index_box().lo));
    CATENA_TRY(map, world_map_of_flirt(map, from_first, size, transform.flirt_reference));
  }
  const AffineMap moved = map.after(as_map(any.mapping()));
  const Mapping mapping = Mapping::from_linear(moved.linear, moved.offset);
  if (!mapping.is_invertible())
    return Error{fmt::format("{}: \"transform\" flattens the data or moves them to infinity; an invertible map was expected", path)};
  if (field.scalar) {
    const std::shared_ptr<const ScalarGrid> grid = field.scalar->grid()->with_mapping(mapping);
    field.scalar = grid;
    // a map of flirt depends on the number of voxels, which a coarser level does not have
    if (!transform.flirt_reference.empty()) field.paged.reset();
    if (field.paged) {
      const AffineMap finer = map.after(as_map(field.paged->mapping()));
      field.paged = field.paged->over(grid, Mapping::from_linear(finer.linear, finer.offset));
    }
  }
  if (field.vector) {
    CATENA_TRY(field.vector, turn_vectors(path, field, mapping, map.linear));
  }
  return field;
}

}  // namespace catena::field
