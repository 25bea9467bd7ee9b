// Vector closed forms. circle, saddle, node and helix use only + - * /: their bits repeat on every machine.
//   circle      (-y, x, 0)                                      saddle  (x, -y, 0)
//   node        (x, y, z): repelling (a negative scale attracts) helix   (-2y, 2x, 0.5)
//   rankine     solid rotation (-y, x, 0) for r <= 1, the free vortex (-y, x, 0) / r^2 beyond
//   lamb-oseen  (-y, x, 0) (1 - exp(-r^2)) / r^2
//   hill        Hill's spherical vortex of radius 1 and speed 1 along z, in the frame of the vortex:
//               inside  (3/2) (x z, y z, 1 - 2 (x^2 + y^2) - z^2), outside the potential flow past the sphere; continuous
//   abc         (A sin z + C cos y, B sin x + A cos z, C sin y + B cos x), A = sqrt 3, B = sqrt 2, C = 1 (period 2 pi)
#include "engine/field/analytic_formula.h"

namespace catena::field {
namespace {

Vec3 circle(const Vec3& p) { return {-p.y, p.x, 0}; }
Vec3 saddle(const Vec3& p) { return {p.x, -p.y, 0}; }
Vec3 node(const Vec3& p) { return p; }
Vec3 helix(const Vec3& p) { return {-2 * p.y, 2 * p.x, 0.5}; }

Vec3 rankine(const Vec3& p) {
  const double r2 = p.x * p.x + p.y * p.y;
  const double w = r2 <= 1 ? 1 : 1 / r2;
  return {-p.y * w, p.x * w, 0};
}

Vec3 lamb_oseen(const Vec3& p) {
  const double r2 = p.x * p.x + p.y * p.y;
  const double w = r2 > 0 ? -std::expm1(-r2) / r2 : 1;
  return {-p.y * w, p.x * w, 0};
}

Vec3 hill(const Vec3& p) {
  const double flat2 = p.x * p.x + p.y * p.y, r2 = flat2 + p.z * p.z;
  if (r2 <= 1) return {1.5 * p.x * p.z, 1.5 * p.y * p.z, 1.5 * (1 - 2 * flat2 - p.z * p.z)};
  const double r = norm(p);
  const Vec3 n(p.x / r, p.y / r, p.z / r);
  const double i3 = 1 / r / r / r;
  return {1.5 * i3 * n.z * n.x, 1.5 * i3 * n.z * n.y, -1 - 0.5 * i3 + 1.5 * i3 * n.z * n.z};
}

Vec3 abc(const Vec3& p) {
  const double a = std::sqrt(3.0), b = std::sqrt(2.0), c = 1;
  return {a * std::sin(p.z) + c * std::cos(p.y), b * std::sin(p.x) + a * std::cos(p.z), c * std::sin(p.y) + b * std::cos(p.x)};
}

constexpr VectorFormula kVectorFormulas[] = {
    {"circle", circle},         {"saddle", saddle}, {"node", node}, {"rankine", rankine},
    {"lamb-oseen", lamb_oseen}, {"hill", hill},     {"abc", abc},   {"helix", helix},
};

}  // namespace

std::span<const VectorFormula> vector_formulas() { return kVectorFormulas; }

}  // namespace catena::field
