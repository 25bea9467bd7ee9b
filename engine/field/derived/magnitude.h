// SPDX-License-Identifier: MIT
/// Largest magnitude X of a field, by which safe normalization divides, and the magnitudes as a grid. Reads the whole field, so not for the
/// haptic tick.
///   vector grids: max |v| over the active voxels; scalar grids: max |grad s| over the centers of the cells
///   formulas: over 33^3 positions in the domain box, finite values only
/// Outliers and fill values (display_range.h), and cells that have one, do not count.
#pragma once
#include <memory>
#include <string>

#include "engine/base/result.h"
#include "engine/field/field.h"

namespace catena::field {

/// Returns the largest magnitude of a vector field, in its own unit.
double compute_max_magnitude(const VectorField& field);
/// Returns the largest gradient magnitude of a scalar field, its unit per world unit; of a paged grid that of its coarse level.
double compute_max_gradient(const ScalarField& field);

/// Makes a grid of |v| at the voxels as 32-bit floats, NaN where v is not finite; cells that the vector grid excludes stay excluded. `what`
/// starts the error messages. Error: the memory budget is exceeded, or no magnitude is a finite float.
Result<std::shared_ptr<const ScalarGrid>> make_magnitude_grid(const VectorGrid& grid, const std::string& what);

}  // namespace catena::field
