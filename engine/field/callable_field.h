// SPDX-License-Identifier: MIT
/// Field defined by a C++ function of the application. The haptic tick evaluates the function exactly, at every position; rendering uses
/// samples of it.
///   value = f(x), gradient = df/dx in world units, in a box of the world
/// A sample is not inside when it is outside of the box or when a number is not finite. The function is also called outside of the box,
/// because searches for a surface look slightly beyond it.
/// The function is called on the haptic thread and by several threads at once. It must not allocate, lock or throw, and must return the
/// same bits for the same position.
#pragma once
#include <functional>
#include <limits>
#include <string>

#include "engine/base/bounds.h"
#include "engine/base/export.h"
#include "engine/field/field.h"

namespace catena::field {

/// Returns the value at a world position and sets the gradient.
using ScalarFunction = std::function<double(const Vec3& world, Vec3& gradient)>;
/// Returns the vector at a position, in world axes; a result that is not finite means that there is no vector.
using VectorFunction = std::function<Vec3(const Vec3& world)>;

/// Makes a scalar field. `domain` must be non-empty and finite; anything else is a bug and asserts. `min_value` and `max_value`: range of
/// the values over all space; an isosurface outside of it is refused.
CATENA_EXPORT ScalarFieldPtr make_callable_field(std::string name, const Bounds& domain, ScalarFunction function,
                                                 double min_value = -std::numeric_limits<double>::infinity(),
                                                 double max_value = std::numeric_limits<double>::infinity());
/// Makes a vector field. `domain` must be non-empty and finite; anything else is a bug and asserts.
CATENA_EXPORT VectorFieldPtr make_callable_field(std::string name, const Bounds& domain, VectorFunction function);

}  // namespace catena::field
