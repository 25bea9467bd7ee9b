// SPDX-License-Identifier: MIT
#include "engine/app/tuning/measure/discretization_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/app/tuning/measure/format_number.h"
#include "engine/field/field_display_range.h"
#include "engine/io/volume/downsample.h"

namespace catena::app::tuning {

namespace {

using field::Index3;

/// Gives the grid the interpolation of `like`; linear if there is no memory for the ghost voxels.
template <class Grid>
std::shared_ptr<const Grid> as(const Grid& like, std::shared_ptr<const Grid> grid) {
  if (like.interpolation() != field::Interpolation::cubic) return grid;
  auto cubic = grid->as_cubic();
  return cubic ? std::move(*cubic) : std::move(grid);
}

auto make(const field::ScalarGrid& like, const field::Mapping& m, const Index3& n, const std::vector<float>& values,
          const std::vector<std::uint8_t>& valid) {
  return as(like, field::make_scalar_grid(like.name(), m, n, values, valid));
}
auto make(const field::VectorGrid& like, const field::Mapping& m, const Index3& n, const std::vector<float>& values,
          const std::vector<std::uint8_t>& valid) {
  return as(like, field::make_vector_grid(like.name(), m, n, values, valid));
}

/// 1 for a voxel with a defined value, that is a corner of a valid cell.
template <class Grid>
std::vector<std::uint8_t> valid_voxels(const Grid& grid, const Index3& origin, const Index3& n) {
  std::vector<std::uint8_t> valid;
  if (!grid.has_mask()) return valid;
  valid.assign(std::size_t(n.x) * n.y * n.z, 0);
  field::Cursor cursor;
  for (int z = 0; z + 1 < n.z; ++z)
    for (int y = 0; y + 1 < n.y; ++y)
      for (int x = 0; x + 1 < n.x; ++x) {
        if (!grid.cell({origin.x + x, origin.y + y, origin.z + z}, cursor).valid) continue;
        for (int c = 0; c < 8; ++c) valid[(std::size_t(z + (c >> 2)) * n.y + (y + (c >> 1 & 1))) * n.x + (x + (c & 1))] = 1;
      }
  return valid;
}

template <class Grid>
std::optional<ResolutionLevels<Grid>> levels_of(const Grid& grid, double max_voxels) {
  const field::Box& box = grid.index_box();
  const Vec3 span = box.hi - box.lo;
  Index3 n;
  for (const auto& [size, length] : {std::pair{&n.x, span.x}, {&n.y, span.y}, {&n.z, span.z}}) {
    if (length < 8) return std::nullopt;
    *size = 4 * (static_cast<int>(length) / 4) + 1;
  }
  if (double(n.x) * n.y * n.z > max_voxels) return std::nullopt;
  const Index3 origin{static_cast<int>(box.lo.x), static_cast<int>(box.lo.y), static_cast<int>(box.lo.z)};
  constexpr int k = std::is_same_v<Grid, field::VectorGrid> ? 3 : 1;
  std::vector<float> all(std::size_t(k) * n.x * n.y * n.z);
  grid.read_block(origin, n, all);
  const std::vector<std::uint8_t> valid = valid_voxels(grid, origin, n);
  ResolutionLevels<Grid> levels;
  for (int level = 0; level < 3; ++level) {
    const int step = 1 << level;
    const Index3 m{(n.x - 1) / step + 1, (n.y - 1) / step + 1, (n.z - 1) / step + 1};
    std::vector<float> values;
    std::vector<std::uint8_t> has;
    values.reserve(std::size_t(k) * m.x * m.y * m.z);
    for (int z = 0; z < n.z; z += step)
      for (int y = 0; y < n.y; y += step)
        for (int x = 0; x < n.x; x += step) {
          const std::size_t i = (std::size_t(z) * n.y + y) * n.x + x;
          for (int c = 0; c < k; ++c) values.push_back(all[k * i + c]);
          if (!valid.empty()) has.push_back(valid[i]);
        }
    if (!has.empty() && std::none_of(has.begin(), has.end(), [](std::uint8_t v) { return v != 0; })) return std::nullopt;
    const field::Mapping& from = grid.mapping();
    levels.grids[level] =
        make(grid, field::Mapping::from_linear(double(step) * from.world_from_index_linear, from.world_from_index(box.lo)), m, values, has);
  }
  return levels;
}

template <class Grid>
std::optional<InterpolationError> floor_of(const Grid& grid, double scale) {
  const auto levels = make_resolution_levels(grid);
  if (!levels) return std::nullopt;
  InterpolationError f;
  f.at_2h = field::compute_difference(*levels->grids[0], *levels->grids[1]).rms;
  f.at_4h = field::compute_difference(*levels->grids[1], *levels->grids[2]).rms;
  f.at_h = extrapolate_from_errors(f.at_2h, f.at_4h);
  if (grid.interpolation() == field::Interpolation::cubic) {
    // the leading part of its error is proportional to t (1 - t) (1 - 2 t) h^3: it appears at the quarters of cells and is 0 midway, where
    // the h^4 term appears. The error lies between the extrapolations of the two: their geometric mean is used lies between what either
    // leads to: their geometric mean
    f.at_4h = field::compute_difference(*levels->grids[0], *levels->grids[2]).rms;
    const double order = std::min(f.at_h.order, 3.0);
    f.at_h.error = std::sqrt(f.at_h.error * f.at_4h / std::exp2(2 * order));
    f.at_h.order = order;
  }
  f.scale = scale;
  return f;
}

}  // namespace

ExtrapolatedError extrapolate_from_errors(double at_2h, double at_4h) {
  if (!(at_2h > 0)) return {0, 4, true};
  const double order = std::log2(at_4h / at_2h), p = std::clamp(order, 0.0, 4.0);
  return {at_2h / std::exp2(p), p, order > 0.5};
}

ExtrapolatedError extrapolate_from_differences(double at_2h, double at_4h) {
  if (!(at_2h > 0)) return {0, 4, true};
  if (!(at_4h / at_2h - 1 > std::exp2(0.9))) return {at_2h / 3, 2, false};
  const double p = std::min(std::log2(at_4h / at_2h - 1), 4.0);
  return {at_2h / (std::exp2(p) - 1), p, true};
}

std::string describe_order(const ExtrapolatedError& e) {
  return e.is_converged ? fmt::format("observed order {:.1f}", e.order)
                        : fmt::format(
                              "at least {}: a third of the difference with every 2nd voxel; the differences converge too slowly for a "
                              "better estimate",
                              format_number(e.error));
}

std::optional<ResolutionLevels<field::ScalarGrid>> make_resolution_levels(const field::ScalarGrid& grid, double max_voxels) {
  return levels_of(grid, max_voxels);
}
std::optional<ResolutionLevels<field::VectorGrid>> make_resolution_levels(const field::VectorGrid& grid, double max_voxels) {
  return levels_of(grid, max_voxels);
}

std::optional<InterpolationError> estimate_interpolation_error(const field::AnyField& field) {
  if (field.scalar && field.scalar->grid() && field.scalar->interpolation() != field::Interpolation::nearest)
    return floor_of(*field.scalar->grid(), field::display_range(field).hi - field::display_range(field).lo);
  if (field.vector && field.vector->grid()) return floor_of(*field.vector->grid(), 2 * field::display_range(field).hi);
  return std::nullopt;
}

}  // namespace catena::app::tuning
