// SPDX-License-Identifier: MIT
// Scalar closed forms with exact gradients. sphere, plane, linear and constant use only + - * / and sqrt: their results are
// bit-identical on every machine.
//   sphere          |x|, gradient 0 at the center               plane      z
//   torus           distance to the circle of radius 1 in z = 0 (level = tube radius); gradient 0 on the circle and the axis
//   constant        1                                           linear     x + y + z
//   gaussian        exp(-|x|^2 / (2 s^2)), s = 0.5              tanh       tanh(z / 0.05): two plateaus and a steep wall
//   marschner-lobb  (1 - sin(pi z / 2) + a (1 + cos(2 pi f cos(pi r / 2)))) / (2 (1 + a)), r^2 = x^2 + y^2, f = 6, a = 0.25
#include <numbers>

#include "engine/field/analytic/analytic.h"

namespace catena::field {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double pi = std::numbers::pi;

double sphere(const Vec3& p, Vec3& g) {
  g = direction(p);
  return norm(p);
}

double plane(const Vec3& p, Vec3& g) {
  g = Vec3(0, 0, 1);
  return p.z;
}

double linear(const Vec3& p, Vec3& g) {
  g = Vec3(1, 1, 1);
  return p.x + p.y + p.z;
}

double constant(const Vec3&, Vec3& g) {
  g = Vec3(0.0);
  return 1;
}

double torus(const Vec3& p, Vec3& g) {
  const Vec3 flat(p.x, p.y, 0);
  const double r = norm(flat);
  const Vec3 to_tube = (r - 1) * direction(flat) + Vec3(0, 0, p.z);
  // the distance has a ridge on the axis, where no radial direction is preferred and the gradient is 0
  g = direction(Vec3(to_tube.x, to_tube.y, p.z));
  const double s = norm(Vec3(r - 1, 0, p.z));
  if (r == 0) g = s > 0 ? Vec3(0, 0, p.z / s) : Vec3(0.0);
  return s;
}

double gaussian(const Vec3& p, Vec3& g) {
  constexpr double s2 = 0.5 * 0.5;
  const double v = std::exp(-dot(p, p) / (2 * s2));
  g = v > 0 ? p * (-v / s2) : Vec3(0.0);
  return v;
}

double plateau(const Vec3& p, Vec3& g) {
  constexpr double width = 0.05;
  const double v = std::tanh(p.z / width);
  const double c = std::cosh(std::fmin(std::fabs(p.z / width), 300.0));
  g = Vec3(0, 0, 1 / (width * c * c));
  return v;
}

double marschner_lobb(const Vec3& p, Vec3& g) {
  constexpr double f = 6, a = 0.25, half = 1 / (2 * (1 + a));
  const Vec3 flat(p.x, p.y, 0);
  const double r = norm(flat);
  const double phase = 2 * pi * f * std::cos(pi * r / 2);
  const double by_r = half * a * std::sin(phase) * 2 * pi * f * std::sin(pi * r / 2) * pi / 2;
  g = by_r * direction(flat) + Vec3(0, 0, -half * std::cos(pi * p.z / 2) * pi / 2);
  return half * (1 - std::sin(pi * p.z / 2) + a * (1 + std::cos(phase)));
}

constexpr ScalarFormula kScalarFormulas[] = {
    {"sphere", sphere, 0, kInfinity},
    {"plane", plane, -kInfinity, kInfinity},
    {"torus", torus, 0, kInfinity},
    {"constant", constant, 1, 1},
    {"linear", linear, -kInfinity, kInfinity},
    {"gaussian", gaussian, std::numeric_limits<double>::min(), 1},  // the infimum 0 is not attained
    {"marschner-lobb", marschner_lobb, 0, 1},
    {"tanh", plateau, -1 + 0x1p-53, 1 - 0x1p-53},  // -1 and 1 are not attained
};

}  // namespace

std::span<const ScalarFormula> scalar_formulas() { return kScalarFormulas; }

// Vector closed forms. circle, saddle, node and helix use only + - * /: their results are bit-identical on every machine.
//   circle      (-y, x, 0)                                      saddle  (x, -y, 0)
//   node        (x, y, z): repelling (a negative scale attracts) helix   (-2y, 2x, 0.5)
//   rankine     solid rotation (-y, x, 0) for r <= 1, the free vortex (-y, x, 0) / r^2 outside
//   lamb-oseen  (-y, x, 0) (1 - exp(-r^2)) / r^2
//   hill        Hill's spherical vortex of radius 1 and speed 1 along z, in the frame that moves with it:
//               inside  (3/2) (x z, y z, 1 - 2 (x^2 + y^2) - z^2), outside the potential flow past the sphere; continuous
//   abc         (A sin z + C cos y, B sin x + A cos z, C sin y + B cos x), A = sqrt 3, B = sqrt 2, C = 1 (period 2 pi)

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

// A left ventricle by formula: a truncated ellipsoidal shell around the long axis z, base up, apex down.
//   e(x)     = sqrt((x^2 + y^2) / a^2 + z^2 / c^2), a = 1, c = 1.5
//   t(x)     = (e - 0.75) / 0.4: transmural depth, 0 at the endocardium, 1 at the epicardium (defined beyond both, too)
//   density  = 1 in the wall (0 <= t <= 1, z <= 0.8), falling as a cubic to 0 over 0.25 of the thickness at either side and
//              over 0.1 above the base
//   fiber    = cos(h) circumferential + sin(h) longitudinal, helix angle h = 60 - 120 t degrees; unit length, in the tangent
//              plane of the shell through the point. Circumferential is (-y, x, 0) / r, longitudinal is up along the wall.
//              Zero outside the support of the density and on the long axis, where no direction is circumferential.

namespace {

constexpr double a2 = 1.0, c2 = 1.5 * 1.5;
constexpr double endocardium = 0.75, thickness = 0.4;
constexpr double side_margin = 0.25, base_z = 0.8, base_margin = 0.1;

/// Returns 1 for u <= 0, 0 for u >= 1 and a cubic with zero end slopes between; sets `slope` to the derivative.
double falloff(double u, double& slope) {
  slope = 0;
  if (u <= 0) return 1;
  if (u >= 1) return 0;
  slope = -6 * u * (1 - u);
  return 1 - u * u * (3 - 2 * u);
}

bool in_support(double t, double z) { return t > -side_margin && t < 1 + side_margin && z < base_z + base_margin; }

}  // namespace

double ventricle_transmural(const Vec3& p, Vec3& gradient) {
  const double e = norm(Vec3(p.x, p.y, p.z / 1.5));
  gradient = e > 0 ? Vec3(p.x / a2, p.y / a2, p.z / c2) / (e * thickness) : Vec3(0.0);
  return (e - endocardium) / thickness;
}

double ventricle_density(const Vec3& p, Vec3& gradient) {
  Vec3 depth_gradient;
  const double t = ventricle_transmural(p, depth_gradient);
  double side_slope, base_slope;
  const bool inner = t < 0.5;
  const double side = falloff((inner ? -t : t - 1) / side_margin, side_slope);
  const double base = falloff((p.z - base_z) / base_margin, base_slope);
  gradient = depth_gradient * (base * side_slope * (inner ? -1 : 1) / side_margin) + Vec3(0, 0, side * base_slope / base_margin);
  return side * base;
}

bool ventricle_fiber(const Vec3& p, Vec3& fibre) {
  fibre = Vec3(0.0);
  Vec3 outward;
  const double t = ventricle_transmural(p, outward);
  const Vec3 around = direction(Vec3(-p.y, p.x, 0));
  if (!in_support(t, p.z) || around == Vec3(0.0)) return false;
  const Vec3 along = cross(direction(outward), around);
  const double helix = (60 - 120 * t) * std::numbers::pi / 180;
  fibre = direction(std::cos(helix) * around + std::sin(helix) * along);
  return true;
}

}  // namespace catena::field
