/// Force balance: p minimises 1/2 K |x - p|^2 + sum 1/2 k_i dist(p, primitive_i)^2, the primitives taken at the last proxy.
///   (K I + sum k_i P_i) (p - x) = sum k_i P_i (o_i - x),   P = I for a point, I - t t' for a line, n n' for a plane
#include "haptics/chain/baseline.h"

namespace catena::haptics {

namespace {

/// Symmetric positive semidefinite 3 x 3, by L D L'; a direction without stiffness stays where it is.
Vec3 solve(const Mat3& a, const Vec3& b) noexcept {
  const double least = 1e-14 * std::max(std::max(a[0][0], a[1][1]), a[2][2]);
  const auto part = [&](double value, double pivot) { return pivot > least ? value / pivot : 0; };
  const double l10 = part(a[0][1], a[0][0]), l20 = part(a[0][2], a[0][0]);
  const double d1 = a[1][1] - l10 * a[0][1];
  const double m = a[1][2] - l10 * a[0][2];
  const double l21 = part(m, d1), d2 = a[2][2] - l20 * a[0][2] - l21 * m;
  const double y1 = b.y - l10 * b.x, y2 = b.z - l20 * b.x - l21 * y1;
  Vec3 x;
  x.z = part(y2, d2);
  x.y = part(y1, d1) - l21 * x.z;
  x.x = part(b.x, a[0][0]) - l10 * x.y - l20 * x.z;
  return x;
}

}  // namespace

Vec3 balance(SingleTick& tick) noexcept {
  const Vec3 last = tick.single.proxy;
  std::array<Primitive, kMaxLinks> primitives;
  std::array<double, kMaxLinks> stiffness{};
  double largest = tick.program.coupling.stiffness_n_per_m;
  tick.each([&](std::size_t i) {
    if (!tick.apply(i, tick.probe) || !tick.primitive(i, last, primitives[i])) return;
    tick.holds[i] = true;
    stiffness[i] = tick.program.links[i].stiffness_n_per_m.at(last, tick.scratch[i].stiffness, tick.links[i].evaluations);
    largest = std::max(largest, stiffness[i]);
  });
  if (!(largest > 0)) return tick.probe;

  // the balance, in units of the largest stiffness
  Mat3 a(tick.program.coupling.stiffness_n_per_m / largest);
  Vec3 b(0.0);
  tick.each([&](std::size_t i) {
    if (!tick.holds[i]) return;
    const Primitive& primitive = primitives[i];
    const double k = stiffness[i] / largest;
    const Vec3 n = primitive.axis, e = primitive.origin - tick.probe;
    Mat3 p(1.0);
    if (primitive.kind != Primitive::Kind::point) {
      const double sign = primitive.kind == Primitive::Kind::line ? -1 : 1;
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) p[c][r] = sign * n[c] * n[r] + (sign < 0 && c == r ? 1 : 0);
    }
    a += k * p;
    b += k * (p * e);
  });
  const Vec3 p = tick.probe + solve(a, b);
  tick.each([&](std::size_t i) {
    if (tick.holds[i]) tick.links[i].residual = distance_to(primitives[i], p);
  });
  return p;
}

}  // namespace catena::haptics
