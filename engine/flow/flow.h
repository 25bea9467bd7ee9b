/// What is followed, and by which method. Any thread.
#pragma once
#include <optional>
#include <string_view>

#include "engine/field/field.h"

namespace catena::flow {

/// linear (Eqs. 1-2 as printed), euler (Eq. 1), rk2 (midpoint), rk3 (Kutta), rk4, rkf34 (Fehlberg 3(4), FSAL, the paper's), dp54
/// (Dormand-Prince). Their coefficients: tableau.h.
enum class Method { linear, euler, rk2, rk3, rk4, rkf34, dp54 };
std::optional<Method> method_from_word(std::string_view word);
const char* method_word(Method method);

/// A direction field to follow: V itself, or a line field (v ~ -v), with speeds at or below min_speed counted as zero.
struct Flow {
  const field::VectorField* field = nullptr;
  bool line = false;
  double min_speed = 0;
};

}  // namespace catena::flow
