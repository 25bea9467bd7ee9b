#include "engine/field/magnitude.h"

#include <algorithm>
#include <mutex>

#include "engine/base/parallel_for.h"
#include "engine/field/grid.h"

namespace catena::field {
namespace {

constexpr int kFormulaNodes = 33;

/// The largest finite size(world, cursor) over the cells' centres of a grid, or the nodes of a formula's box.
template <class Size>
double largest(const Field& field, const Size& size) {
  const Box& box = field.index_box();
  const Vec3 extent = box.hi - box.lo;
  const auto places = [&](int axis) { return field.is_grid() ? std::max(1, static_cast<int>(extent[axis])) : kFormulaNodes; };
  const int nx = places(0), ny = places(1), nz = places(2);
  const auto place = [&](int axis, int i, int n) {
    return field.is_grid() ? box.lo[axis] + std::min(i + 0.5, extent[axis]) : box.lo[axis] + extent[axis] * i / (n - 1);
  };
  double most = 0;
  std::mutex mutex;
  parallel_for(static_cast<std::size_t>(nz), 1, [&](std::size_t begin, std::size_t end) {
    Cursor cursor;
    double here = 0;
    for (int z = static_cast<int>(begin); z < static_cast<int>(end); ++z)
      for (int y = 0; y < ny; ++y)
        for (int x = 0; x < nx; ++x) {
          const double m = size(field.mapping().world_from_index(Vec3(place(0, x, nx), place(1, y, ny), place(2, z, nz))), cursor);
          if (std::isfinite(m)) here = std::max(here, m);
        }
    const std::lock_guard lock(mutex);
    most = std::max(most, here);
  });
  return most;
}

}  // namespace

double largest_magnitude(const VectorField& field) {
  if (field.grid() != nullptr) return field.grid()->stats().max;
  return largest(field, [&](const Vec3& world, Cursor& cursor) { return norm(field.sample(world, cursor).value); });
}

double largest_gradient(const ScalarField& field) {
  return largest(field, [&](const Vec3& world, Cursor& cursor) {
    const ScalarSample sample = field.sample(world, cursor);
    return sample.inside ? norm(sample.gradient) : 0.0;
  });
}

}  // namespace catena::field
