// SPDX-License-Identifier: MIT
/// Fields whose value at a node is a function of other fields' values there: components joined to a vector, another grid's nodes, and
/// expressions, which muParser evaluates. The result is a grid of 32-bit floats over the nodes of a grid or of a cube; a node has a value
/// where all fields that are used have one and the result is finite. Fields over the same nodes are read there, others are interpolated.
/// Expressions: operators, functions and constants of muParser; variables, and x, y, z (world) and t (time). Transcendental functions are
/// those of the C library, so that recordings replay bit by bit only where it is the same.
/// Not for the haptic tick; any thread.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "engine/base/export.h"
#include "engine/base/result.h"
#include "engine/field/field.h"

namespace catena::field {

/// Variable of an expression: a scalar field, or a component (0 to 2) of a vector field.
struct NodeVariable {
  std::string name;   ///< as in the expression
  AnyField field;     ///< its values
  int component = 0;  ///< of a vector field
};

/// Nodes at which a field is made: those of a grid, or of a cube.
struct Nodes {
  AnyField on{};                     ///< set: the nodes of this grid
  int resolution = 0;                ///< otherwise: nodes along each axis, from box[0] to box[1]
  std::array<double, 2> box{-2, 2};  ///< world units
};

/// Why an expression is not usable, and the column of its text, from 1; an empty message: it is usable.
struct ExpressionFault {
  std::string message;  ///< empty: none
  int column = 0;       ///< from 1
};

/// Checks an expression with the given variables.
CATENA_EXPORT ExpressionFault check_expression(const std::string& expression, const std::vector<std::string>& variables);

/// Evaluates one expression (a scalar field) or three (a vector field), which check_expression() accepts. A note of the result counts the
/// nodes at which it is not finite. Error (a message fragment): no node has a value, or there is no memory.
CATENA_EXPORT Result<AnyField> evaluate_expressions(const std::vector<std::string>& expressions, const std::vector<NodeVariable>& variables,
                                                    double time, const Nodes& nodes, const std::string& name);

/// Samples a field at the nodes of another grid. Errors as above.
CATENA_EXPORT Result<AnyField> resample(const AnyField& field, const Nodes& nodes, const std::string& name);

/// Joins three scalar fields to a vector field. Errors as above.
CATENA_EXPORT Result<AnyField> join_components(const std::array<AnyField, 3>& components, const Nodes& nodes, const std::string& name);

}  // namespace catena::field
