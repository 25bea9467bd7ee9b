// SPDX-License-Identifier: MIT
/// Quantities of fields that are formulas, at any position: derivatives by differences of sixth order over 1e-3 world units, relative error
/// about 1e-12 where the formula is smooth. Private to this module.
#pragma once
#include <string>

#include "engine/base/result.h"
#include "engine/field/derived/quantities.h"
#include "engine/field/field.h"

namespace catena::field {

/// Returns a quantity that `field`, a formula, has. `is_vector`: the quantity is a vector.
Result<AnyField> derive_formula(const AnyField& field, Quantity quantity, bool is_vector, const std::string& name);
/// Returns a component of a formula.
Result<AnyField> component_of_formula(const VectorFieldPtr& field, int component, const std::string& name);

}  // namespace catena::field
