/// The largest magnitude X of a field: what safe normalisation divides by. Off the tick: it reads the whole field.
///   vector grids: max |v| over the active voxels; scalar grids: max |grad s| over the cells' centres
///   formulas: over 33^3 places of the box -2..2, finite ones only
/// Outliers and fill values (display_range.h) do not count, nor do cells with one.
/// And the magnitudes themselves as a grid.
#pragma once
#include <memory>
#include <string>

#include "engine/base/result.h"
#include "engine/field/field.h"

namespace catena::field {

double compute_max_magnitude(const VectorField& field);
double compute_max_gradient(const ScalarField& field);

/// |v| at the voxels as 32-bit floats, NaN where v is; cells that the vector grid excludes are excluded. `what` begins the errors: the
/// grid would take more memory than is allowed, or no magnitude is a finite float.
Result<std::shared_ptr<const ScalarGrid>> make_magnitude_grid(const VectorGrid& grid, const std::string& what);

}  // namespace catena::field
