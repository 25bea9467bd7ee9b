// SPDX-License-Identifier: MIT
// Vortices in a uniform stream, with random parameters from a seed. The field differs for every seed and is divergence-free.
//   v(p) = v_0 + sum_i w_i x (p - c_i) / (1 + |p - c_i|^2 / r_i^2)^2
// |v_0| = 0.5; c_i in [-2, 2]^3, r_i from 0.4 to 0.9, |w_i| from 1 to 2.5 with either sense of rotation. In two dimensions c_i, v_0 and v
// lie in the xy plane, w_i is along z, and nothing depends on z. Each term is w x d times a function of |d|^2, whose gradient is along d
// and thus orthogonal to it: div v = 0. Only + - * / and square roots are used: the results are bit-identical on every machine.
#include "engine/base/random.h"
#include "engine/field/analytic/analytic.h"

namespace catena::field {
namespace {

/// Returns a random unit vector, uniform over the sphere, or over the circle if `flat`: rejection sampling in the ball or disc.
Vec3 unit(Random& random, bool flat) {
  while (true) {
    const Vec3 p(random.between(-1, 1), random.between(-1, 1), flat ? 0.0 : random.between(-1, 1));
    const double length2 = dot(p, p);
    if (length2 <= 1 && length2 > 0.01) return direction(p);
  }
}

}  // namespace

Vortices::Vortices(int seed, int dimensions) : is_2d_(dimensions == 2) {
  Random random(mix_bits(static_cast<std::uint64_t>(seed)) ^ static_cast<std::uint64_t>(dimensions));
  stream_ = 0.5 * unit(random, is_2d_);
  for (Vortex& vortex : vortices_) {
    for (int axis = 0; axis < (is_2d_ ? 2 : 3); ++axis) vortex.center[axis] = random.between(-2, 2);
    const double radius = random.between(0.4, 0.9), rate = random.between(1, 2.5) * (random.below(2) == 0 ? -1 : 1);
    vortex.inverse_radius2 = 1 / (radius * radius);
    vortex.rate = rate * (is_2d_ ? Vec3(0, 0, 1) : unit(random, false));
  }
}

Vec3 Vortices::value(const Vec3& p) const noexcept {
  Vec3 sum = stream_;
  for (const Vortex& vortex : vortices_) {
    Vec3 offset = p - vortex.center;
    if (is_2d_) offset.z = 0;
    const double falloff = 1 + dot(offset, offset) * vortex.inverse_radius2;
    sum += cross(vortex.rate, offset) * (1 / (falloff * falloff));
  }
  return sum;
}

}  // namespace catena::field
