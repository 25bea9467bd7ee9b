/// The trilinear cell: eight corners are the whole polynomial, so one fetch gives value, gradient and Hessian, exactly.
///   s(f) = sum over corners of c_ijk * (x-weight)(y-weight)(z-weight),  f = index - base in [0, 1]^3
/// Corner order: corner[i + 2 j + 4 k] at base + (i, j, k). Gradients are by index; Mapping turns them to world.
#pragma once
#include <array>
#include <cstdint>

#include "engine/base/vec.h"

namespace catena::field {

struct Index3 {
  std::int32_t x = 0, y = 0, z = 0;
  bool operator==(const Index3&) const = default;
};

struct ScalarCell {
  Index3 base;
  bool valid = false;  ///< inside the domain, and all eight corners valid where the grid has a `valid` mask
  std::array<double, 8> corner{};

  double value(const Vec3& f) const;
  Vec3 gradient(const Vec3& f) const;             ///< by index
  /// Mixed second derivatives by index; the diagonal of a trilinear function is zero. Returns (d2/dydz, d2/dxdz, d2/dxdy).
  Vec3 mixed_second(const Vec3& f) const;
  void value_and_gradient(const Vec3& f, double& value, Vec3& gradient) const;
};

struct VectorCell {
  Index3 base;
  bool valid = false;
  std::array<Vec3, 8> corner{};

  Vec3 value(const Vec3& f) const;
  /// For line fields (v ~ -v): every corner is turned to the side of `reference` before it is interpolated.
  void align(const Vec3& reference);
};

}  // namespace catena::field
