// SPDX-License-Identifier: MIT
/// Expressions of one thread, evaluated by muParser. Not part of the library's interface.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "engine/base/vec.h"
#include "engine/field/derived/node_function.h"

namespace catena::field {

/// One to three expressions that check_expression() accepts, with their variables.
class Expressions {
 public:
  Expressions(const std::vector<std::string>& texts, const std::vector<NodeVariable>& variables, double time);
  ~Expressions();
  Expressions(Expressions&&) = delete;
  /// Sets variable i.
  void set(std::size_t i, double value);
  /// Sets the variable t.
  void set_time(double time);
  /// Evaluates the expressions at a position: the first components of `result`.
  void evaluate(const Vec3& world, Vec3& result);

 private:
  struct Parsers;
  std::unique_ptr<Parsers> parsers_;
};

}  // namespace catena::field
