// SPDX-License-Identifier: MIT
/// Affine map of positions: p -> linear p + offset. Pure functions, any thread.
#pragma once
#include <glm/matrix.hpp>

#include "engine/base/vec.h"

namespace catena {

/// Affine map; the identity by default.
struct AffineMap {
  Mat3 linear{1.0};  ///< Matrix, stored column by column
  Vec3 offset{0.0};  ///< Image of the origin
  bool operator==(const AffineMap&) const = default;

  /// Returns the image of the position p.
  Vec3 operator()(const Vec3& p) const { return linear * p + offset; }
  /// Returns the map that applies `first` and then this one.
  AffineMap after(const AffineMap& first) const { return {linear * first.linear, (*this)(first.offset)}; }
  /// Returns the inverse map; its numbers are not finite if there is none.
  AffineMap inverse() const {
    const Mat3 back = glm::inverse(linear);
    return {back, -(back * offset)};
  }
};

}  // namespace catena
