// SPDX-License-Identifier: MIT
/// Fields derived from other fields. Of grids: a grid of 32-bit floats over the same nodes, from differences between nodes (node_slab.h),
/// interpolated as the grid that it is made of; where a neighbor that a derivative needs is missing, there is no value. Of formulas: the
/// formula's derivatives, by differences of sixth order over 1e-3 world units, at any position. Not for the haptic tick; any thread; the
/// same bits with any number of threads.
#pragma once
#include <string>
#include <vector>

#include "engine/base/export.h"
#include "engine/base/result.h"
#include "engine/field/derived/quantities.h"
#include "engine/field/field.h"

namespace catena::field {

/// Returns a quantity of a field. `order`: of the differences at nodes away from borders and masks, 2 or 4. Error (a message fragment): the
/// field has no such quantity, or there is no memory.
CATENA_EXPORT Result<AnyField> derive(const AnyField& field, Quantity quantity, int order, const std::string& name);

/// Returns a component of a vector field: 0, 1, 2 for x, y, z in world axes.
CATENA_EXPORT Result<AnyField> derive_component(const AnyField& field, int component, const std::string& name);

/// Returns a grid smoothed by a Gaussian of standard deviation `sigma` along each index axis, world units, truncated at 4 sigma. Nodes
/// without a value have no weight, and stay without one. Error: the field is no grid, `sigma` is more than kMaxSmoothing voxels, or there
/// is no memory.
CATENA_EXPORT Result<AnyField> smooth(const AnyField& field, double sigma, const std::string& name);
/// Largest standard deviation of smooth(), voxels.
inline constexpr double kMaxSmoothing = 64;

}  // namespace catena::field
