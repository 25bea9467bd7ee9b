/// The largest magnitude X of a field: what safe normalisation divides by. Off the tick: it reads the whole field.
///   vector grids: max |v| over the active voxels; scalar grids: max |grad s| over the cells' centres
///   formulas: over 33^3 places of the box -2..2, finite ones only
#pragma once
#include "engine/field/field.h"

namespace catena::field {

double largest_magnitude(const VectorField& field);
double largest_gradient(const ScalarField& field);

}  // namespace catena::field
