// SPDX-License-Identifier: MIT
/// Automatic display range of a field (engine/base/display_range.h), and values sampled across a grid. Not for the haptic tick; any thread.
#pragma once
#include <functional>
#include <span>
#include <vector>

#include "engine/base/display_range.h"
#include "engine/field/grid/grid.h"

namespace catena::field {

/// Returns the display range of the active, valid values of a grid; of the magnitudes for a vector grid. Computed once per grid and cached:
/// from about 2^17 values spread over the grid, then from all values when there are outliers; range and counts are exact then. For data
/// that were resampled it is the range of the values in the file.
const DisplayRange& display_range(const ScalarGrid& grid);
const DisplayRange& display_range(const VectorGrid& grid);
/// Returns the display range of a scalar field: for a formula, the range of all its values.
DisplayRange display_range(const ScalarField& field);
/// Returns the display range of a scalar or vector field; 0 to 0 for a vector formula.
DisplayRange display_range(const AnyField& field);

/// Returns the display range of values sampled from a field, for example along a line or at glyphs: their minimum and maximum, without the
/// values outside of the field's own display range (outliers and mixtures with them). When `of` has no field, the range of the values by
/// themselves.
DisplayRange display_range(std::span<const double> values, const AnyField& of);

/// Calls visit(origin, extent, voxels) for blocks of 8^3 voxels (smaller at the end of the box) spread over the box, at most about
/// `max_samples` voxels in total.
using BlockVisitor = std::function<void(const Index3&, const Index3&, std::size_t)>;
void for_sampled_blocks(const Box& box, std::size_t max_samples, const BlockVisitor& visit);

/// Returns at most about `max_samples` finite values of valid voxels, sampled in blocks of 8^3 spread over the grid. A voxel counts as
/// valid when the cell based at it is valid.
std::vector<float> sample_values(const ScalarGrid& grid, std::size_t max_samples);

/// Returns at most about `max_samples` finite magnitudes of valid voxels of a vector grid, sampled in blocks as sample_values() does.
std::vector<float> sample_magnitudes(const VectorGrid& grid, std::size_t max_samples);

}  // namespace catena::field
