/// A field that is a function of a program's own: sampled exactly, at every place, by the hand; drawn from samples.
///   value = f(x), gradient = df/dx in world units, within a box of the world. OutwardSide the box, and where a number is not finite, a
///   sample is not inside; the function is asked there all the same, because searches for a surface look a little beyond.
/// The function is called on the haptic thread and by several threads at once: it allocates nothing, takes no lock, throws nothing, and the
/// same place gives the same bits.
#pragma once
#include <functional>
#include <limits>
#include <string>

#include "engine/base/bounds.h"
#include "engine/field/field.h"

namespace catena::field {

/// Gives the value and sets the gradient.
using ScalarFunction = std::function<double(const Vec3& world, Vec3& gradient)>;
/// Gives the vector in world axes; not finite: there is none at this place.
using VectorFunction = std::function<Vec3(const Vec3& world)>;

/// `domain` holds a point and is finite; anything else is a bug, which asserts. `least` and `most`: the values that it attains over all
/// space. An isosurface beyond them is refused.
ScalarFieldPtr make_callable_field(std::string name, const Bounds& domain, ScalarFunction function,
                                   double least = -std::numeric_limits<double>::infinity(),
                                   double most = std::numeric_limits<double>::infinity());
/// The same of vectors.
VectorFieldPtr make_callable_field(std::string name, const Bounds& domain, VectorFunction function);

}  // namespace catena::field
