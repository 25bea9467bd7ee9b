// SPDX-License-Identifier: MIT
// Writes .vdb: the nodes of grids in memory, or the slices of a file that is being read, are sent unchanged to the program catena-write.
#include <fmt/format.h>

#include <cmath>
#include <glm/matrix.hpp>

#include "engine/base/result.h"
#include "engine/field/grid/grid_storage.h"
#include "engine/field/nanovdb/nano_nodes.h"
#include "engine/io/formats.h"
#include "engine/io/protocol.h"
#include "engine/io/volume/vdb_stream.h"

namespace catena::field {
namespace {

Outcome check_volume(const std::string& path, const Mapping& mapping) {
  // OpenVDB treats smaller voxels as degenerate
  const double volume = std::fabs(glm::determinant(mapping.world_from_index_linear));
  if (!(volume > 3e-15) || !std::isfinite(volume))
    return Error{fmt::format("{}: a .vdb cannot store voxels of volume {:g}; more than 3e-15 was expected: choose a smaller unit of length",
                             path, volume)};
  return Done{};
}

bool same_voxels(const NanoMask& a, const NanoMask& b) {
  if (&a == &b) return true;
  if (count_voxels(a) != count_voxels(b)) return false;
  // the counts are equal, and each voxel of one mask is in the other
  const NanoNodes<nanovdb::ValueMask> nodes = view_nodes(a);
  const MaskView other(b);
  for (const auto& leaf : nodes.leaves)
    for (int x = 0; x < 8; ++x)
      if ((leaf.mValueMask.getWord<std::uint64_t>(x) & ~other.word(leaf.mBBoxMin, x)) != 0) return false;
  bool all = true;
  const auto check_tile = [&](const nanovdb::Coord& origin, std::int32_t edge, bool) { all = all && other.all(origin, edge); };
  for (const auto& lower : nodes.lowers) for_active_tiles(lower, check_tile);
  for (const auto& upper : nodes.uppers) for_active_tiles(upper, check_tile);
  for (const auto& entry : nodes.entries)
    if (entry.isActive()) check_tile(entry.origin(), kUpperEdge, true);
  return all;
}

const float* numbers(const float& v) { return &v; }
const float* numbers(const nanovdb::Vec3f& v) { return &v[0]; }
const float* numbers(const bool&) { return nullptr; }
bool same(const float& a, const float& b) { return std::memcmp(&a, &b, sizeof a) == 0; }
bool same(const nanovdb::Vec3f& a, const nanovdb::Vec3f& b) { return std::memcmp(&a, &b, sizeof a) == 0; }
bool same(bool a, bool b) { return a == b; }

template <class Leaf>
const void* values_of(const Leaf& leaf) {
  return leaf.mValues;
}
template <>
const void* values_of(const NanoTypes<nanovdb::ValueMask>::Leaf&) {
  return nullptr;
}

/// Sends all nodes of the buffer, except inactive tiles of the background value.
template <class T>
void stream_nodes(VdbStreamWriter& out, const nanovdb::NanoGrid<T>& grid) {
  using Value = typename NanoTypes<T>::Value;
  const NanoNodes<T> nodes = view_nodes(grid);
  const Value background = grid.tree().background();
  const auto tile = [&](const nanovdb::Coord& origin, std::int32_t edge, const Value& value, bool active) {
    if (active || !same(value, background)) out.write_tile(origin, edge, numbers(value), active);
  };
  for (const auto& entry : nodes.entries)
    if (entry.isValue()) tile(entry.origin(), kUpperEdge, entry.value, entry.state != 0);
  for (const auto& upper : nodes.uppers)
    for (std::uint32_t n = 0; n < kUpperEntries; ++n)
      if (!upper.mChildMask.isOn(n)) tile(upper_coord(upper.mBBox[0], n), kLowerEdge, upper.mTable[n].value, upper.mValueMask.isOn(n));
  for (const auto& lower : nodes.lowers)
    for (std::uint32_t n = 0; n < kLowerEntries; ++n)
      if (!lower.mChildMask.isOn(n)) tile(lower_coord(lower.mBBox[0], n), kLeafEdge, lower.mTable[n].value, lower.mValueMask.isOn(n));
  for (const auto& leaf : nodes.leaves) out.write_leaf(leaf.mBBoxMin, leaf.mValueMask, values_of(leaf));
  out.end_grid();
}

template <class T>
Result<bool> stream_layers(VdbStreamWriter& out, const DenseSource& source) {
  DenseSlab<T> slab(source);
  bool some_finite = false;
  T values[512];
  for (int z = 0; z < source.size.z; z += kLeafEdge) {
    CATENA_CHECK(slab.read(z));
    for (std::size_t b = 0; b < slab.block_count(); ++b) {
      T value;
      if (slab.is_constant(b, value)) {
        out.write_tile(slab.origin(b), kLeafEdge, numbers(value), true);
        some_finite = true;
        continue;
      }
      nanovdb::Mask<3> active;
      std::fill_n(values, 512, T(0.f));
      slab.gather(b, values, active);
      out.write_leaf(slab.origin(b), active, values);
      for (std::uint32_t n = 0; n < 512 && !some_finite; ++n) some_finite = active.isOn(n) && is_finite_value(values[n]);
    }
  }
  out.end_grid();
  return some_finite;
}

}  // namespace

Outcome write_vdb(const std::string& path, const std::vector<NamedGrid>& items) {
  // a file holds a single mask
  const NanoMask *mask = nullptr, *cells = nullptr;
  bool cells_masked = false;
  const Field* masked = nullptr;
  for (const NamedGrid& item : items) {
    CATENA_CHECK(check_volume(path, item.field.get()->mapping()));
    const ScalarGrid* scalar = item.field.scalar ? item.field.scalar->grid() : nullptr;
    const VectorGrid* vector = item.field.vector ? item.field.vector->grid() : nullptr;
    CATENA_ASSERT(scalar || vector);
    const NanoMask* grid_mask = scalar ? scalar->storage().valid_voxels : vector->storage().valid_voxels;
    if (!grid_mask) continue;
    const NanoMask* grid_cells = scalar ? scalar->storage().valid_cells : vector->storage().valid_cells;
    cells_masked = cells_masked || (scalar ? scalar->storage().has_cell_mask : vector->storage().has_cell_mask);
    if (mask && (!same_voxels(*mask, *grid_mask) || (cells_masked && !same_voxels(*cells, *grid_cells))))
      return Error{fmt::format("{}: the grids have different masks, expected one mask for the file", path)};
    mask = grid_mask;
    cells = grid_cells;
    masked = item.field.get();
  }
  CATENA_TRY(VdbStreamWriter out, VdbStreamWriter::open(path));
  for (const NamedGrid& item : items) {
    const Mapping& mapping = item.field.get()->mapping();
    if (item.field.scalar) {
      const auto& grid = *item.field.scalar->grid()->storage().values;
      const float background = grid.tree().background();
      out.begin_grid(StreamKind::scalar, item.name, mapping, &background, false);
      stream_nodes(out, grid);
    } else {
      const auto& grid = *item.field.vector->grid()->storage().values;
      const nanovdb::Vec3f background = grid.tree().background();
      out.begin_grid(StreamKind::vector, item.name, mapping, numbers(background), false);
      stream_nodes(out, grid);
    }
  }
  if (mask) {
    out.begin_grid(StreamKind::mask, "valid", masked->mapping(), nullptr, false);
    stream_nodes(out, *mask);
  }
  if (cells_masked) {
    out.begin_grid(StreamKind::mask, std::string(kCellMaskName), masked->mapping(), nullptr, false);
    stream_nodes(out, *cells);
  }
  return out.finish();
}

Result<std::string> import_as_vdb(const LoadRequest& request, const std::string& path, const std::string& name) {
  const io::Format* format = io::find_reader(request.path, io::DataKind::volume);
  const auto name_or = [&](const std::string& own_name) {
    return !name.empty() ? name : !own_name.empty() ? own_name : io::file_stem(request.path);
  };
  if (format == nullptr || format->volume.open == nullptr) {
    CATENA_TRY(const AnyField field, load(request));
    const std::string chosen_name = name_or(field.get()->name());
    CATENA_CHECK(write_vdb(path, {{field, chosen_name}}));
    return chosen_name;
  }
  CATENA_TRY(const DenseFile file, format->volume.open(request));
  CATENA_CHECK(check_volume(path, file.mapping));
  CATENA_TRY(VdbStreamWriter out, VdbStreamWriter::open(path));
  const std::string chosen_name = name_or(file.name);
  const float background[3]{};
  const bool vector = file.components == 3;
  out.begin_grid(vector ? StreamKind::vector : StreamKind::scalar, chosen_name, file.mapping, background, true);
  CATENA_TRY(const bool some_finite, vector ? stream_layers<nanovdb::Vec3f>(out, file.source) : stream_layers<float>(out, file.source));
  if (!some_finite) return Error{file.prefix + "has no finite value in any active voxel"};
  count_file();
  count_grid();
  CATENA_CHECK(out.finish());
  return chosen_name;
}

}  // namespace catena::field
