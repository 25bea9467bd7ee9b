// SPDX-License-Identifier: MIT
#include "engine/field/derived/magnitude.h"

#include <algorithm>
#include <mutex>

#include "engine/base/threads.h"
#include "engine/field/field_display_range.h"
#include "engine/field/grid/dense.h"
#include "engine/field/grid/grid.h"
#include "engine/field/grid/grid_storage.h"

namespace catena::field {
namespace {

constexpr int kFormulaNodes = 33;

/// Returns the largest finite size(world, cursor) over the cell centers of a grid, or over the nodes of a formula's box.
template <class Size>
double largest(const Field& field, const Size& size) {
  const Box& box = field.index_box();
  const Vec3 extent = box.hi - box.lo;
  const auto position_count = [&](int axis) { return field.is_grid() ? std::max(1, static_cast<int>(extent[axis])) : kFormulaNodes; };
  const int nx = position_count(0), ny = position_count(1), nz = position_count(2);
  const auto coordinate = [&](int axis, int i, int n) {
    return field.is_grid() ? box.lo[axis] + std::min(i + 0.5, extent[axis]) : box.lo[axis] + extent[axis] * i / (n - 1);
  };
  double maximum = 0;
  std::mutex mutex;
  parallel_for(static_cast<std::size_t>(nz), 1, [&](std::size_t begin, std::size_t end) {
    Cursor cursor;
    double local_maximum = 0;
    for (int z = static_cast<int>(begin); z < static_cast<int>(end); ++z)
      for (int y = 0; y < ny; ++y)
        for (int x = 0; x < nx; ++x) {
          const double m =
              size(field.mapping().world_from_index(Vec3(coordinate(0, x, nx), coordinate(1, y, ny), coordinate(2, z, nz))), cursor);
          if (std::isfinite(m)) local_maximum = std::max(local_maximum, m);
        }
    const std::lock_guard lock(mutex);
    maximum = std::max(maximum, local_maximum);
  });
  return maximum;
}

/// Marks the corners of all valid cells, in slices z .. z + layers - 1 of the box. A cell whose corners are all marked becomes valid as
/// well.
void mark_corners(const VectorGrid& grid, const Index3& size, int z, int layers, std::span<std::uint8_t> valid) {
  std::fill(valid.begin(), valid.end(), std::uint8_t{0});
  const std::size_t plane = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
  const Box& box = grid.index_box();
  Cursor cursor;
  for (int base = std::max(0, z - 1); base < z + layers && base + 1 < size.z; ++base)
    for (int y = 0; y + 1 < size.y; ++y)
      for (int x = 0; x + 1 < size.x; ++x) {
        if (!grid.sample(grid.mapping().world_from_index(box.lo + Vec3(x + 0.5, y + 0.5, base + 0.5)), cursor).inside) continue;
        for (int i = 0; i < 8; ++i) {
          const int layer = base + (i >> 2) - z;
          if (layer < 0 || layer >= layers) continue;
          valid[static_cast<std::size_t>(layer) * plane + static_cast<std::size_t>(y + ((i >> 1) & 1)) * static_cast<std::size_t>(size.x) +
                static_cast<std::size_t>(x + (i & 1))] = 1;
        }
      }
}

}  // namespace

double compute_max_magnitude(const VectorField& field) {
  if (field.grid() != nullptr) return display_range(*field.grid()).hi;
  return largest(field, [&](const Vec3& world, Cursor& cursor) { return norm(field.sample(world, cursor).value); });
}

double compute_max_gradient(const ScalarField& any) {
  const ScalarField& field = any.cells() ? any.cells()->resident_grid() : any;
  const DisplayRange range = display_range(field);
  return largest(field, [&](const Vec3& world, Cursor& cursor) {
    const ScalarSample sample = field.sample(world, cursor);
    // outliers are skipped; the center of a cell with an outlier at a corner is out of range as well
    const bool counts = (range.below.count == 0 || sample.value >= range.lo) && (range.above.count == 0 || sample.value <= range.hi);
    return sample.inside && counts ? norm(sample.gradient) : 0.0;
  });
}

Result<std::shared_ptr<const ScalarGrid>> make_magnitude_grid(const VectorGrid& grid, const std::string& what) {
  const Box& box = grid.index_box();
  const Index3 origin{static_cast<int>(box.lo.x), static_cast<int>(box.lo.y), static_cast<int>(box.lo.z)};
  const Index3 size{static_cast<int>(box.hi.x - box.lo.x) + 1, static_cast<int>(box.hi.y - box.lo.y) + 1,
                    static_cast<int>(box.hi.z - box.lo.z) + 1};
  CATENA_CHECK(check_dense_memory(what, size, 1, grid.has_mask()));

  // the magnitudes are computed slice by slice
  const std::size_t plane = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
  std::vector<float> xyz(3 * plane);
  const auto read = [&](int z, int layers, std::span<float> values, std::span<std::uint8_t> valid) -> Outcome {
    for (int layer = 0; layer < layers; ++layer) {
      grid.read_block({origin.x, origin.y, origin.z + z + layer}, {size.x, size.y, 1}, xyz);
      for (std::size_t i = 0; i < plane; ++i)
        values[static_cast<std::size_t>(layer) * plane + i] = static_cast<float>(norm(Vec3(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2])));
    }
    if (!valid.empty()) mark_corners(grid, size, z, layers, valid);
    return Done{};
  };
  Mapping mapping = grid.mapping();
  mapping.origin = mapping.world_from_index(box.lo);
  DenseSource source{size, grid.has_mask(), read};
  const VectorGrid::Storage& storage = grid.storage();
  if (storage.has_cell_mask)
    source.read_cells = [&](int z, int layers, std::span<std::uint8_t> cells) -> Outcome {
      const auto valid = storage.valid_cells->getAccessor();
      std::size_t n = 0;
      for (int k = z; k < z + layers; ++k)
        for (int j = 0; j < size.y; ++j)
          for (int i = 0; i < size.x; ++i, ++n) {
            const Index3 base{origin.x + i, origin.y + j, origin.z + k};
            cells[n] = !storage.is_legal_base(base) || storage.is_cell_valid(valid, base) ? 1 : 0;
          }
      return Done{};
    };
  source.range = storage.data_range;
  auto result = make_dense_grid<ScalarGrid>(grid.name(), mapping, source, what + " ");
  if (!result) return Error{result.error().message + "; magnitudes that fit into 32-bit floats were expected"};
  return result;
}

}  // namespace catena::field
