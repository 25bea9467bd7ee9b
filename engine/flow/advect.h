/// The advection function f_V of Eqs. 3-4: one call carries p along V for a signed time dt.
///   f_V(p, -dt) equals f_-V(p, dt) bit for bit (Eq. 4): every method only ever forms products h * v.
/// Methods: euler (Eq. 1), rk2 (midpoint), rk3 (Kutta), rk4, rkf34 (Fehlberg 3(4), FSAL, the paper's), dp54 (Dormand-Prince).
/// The embedded pairs choose their own sub-steps: the estimated error of each is <= tolerance * L.
/// Any thread; no allocation, lock or throw.
#pragma once
#include <array>
#include <optional>
#include <string_view>

#include "engine/field/field.h"

namespace catena::flow {

enum class Method { linear, euler, rk2, rk3, rk4, rkf34, dp54 };
std::optional<Method> method_from_word(std::string_view word);
const char* method_word(Method method);

/// A direction field to follow: V itself, or a line field (v ~ -v), with speeds at or below min_speed counted as zero.
struct Flow {
  const field::VectorField* field = nullptr;
  bool line = false;
  double min_speed = 0;
};

struct Advected {
  Vec3 displacement{0.0};  ///< f_V(p, dt); the paper adds it to p
  int evaluations = 0;
  bool inside = true;    ///< false: a stage left the domain; the displacement stops before it
  bool complete = true;  ///< false: the evaluation cap was reached first
};

/// f_V(p, dt) in the field's own time. `linear` and `euler` take one step; fixed methods one step; pairs as many as needed.
Advected advect(const Flow& flow, const Vec3& p, double dt, Method method, double tolerance_length, field::Cursor& cursor,
                int cap = 100000);

}  // namespace catena::flow
