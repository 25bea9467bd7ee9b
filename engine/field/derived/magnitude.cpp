// SPDX-License-Identifier: MIT
#include "engine/field/derived/magnitude.h"

#include <algorithm>
#include <mutex>

#include "engine/base/threads.h"
#include "engine/field/field_display_range.h"
#include "engine/field/grid/grid.h"

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

}  // namespace catena::field
