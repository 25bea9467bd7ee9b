// Scalar closed forms with exact gradients. sphere, plane, linear and constant use only + - * / and sqrt: their bits repeat on
// every machine.
//   sphere          |x|, gradient 0 at the centre               plane      z
//   torus           distance to the circle of radius 1 in z = 0 (level = tube radius); gradient 0 on the circle and the axis
//   constant        1                                           linear     x + y + z
//   gaussian        exp(-|x|^2 / (2 s^2)), s = 0.5              tanh       tanh(z / 0.05): two plateaus and a steep wall
//   marschner-lobb  (1 - sin(pi z / 2) + a (1 + cos(2 pi f cos(pi r / 2)))) / (2 (1 + a)), r^2 = x^2 + y^2, f = 6, a = 0.25
#include "engine/field/analytic_formula.h"

#include <numbers>

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
  // on the axis the distance has a ridge: every radial direction is as good, none is taken
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
    {"gaussian", gaussian, std::numeric_limits<double>::min(), 1},  // 0 is not attained
    {"marschner-lobb", marschner_lobb, 0, 1},
    {"tanh", plateau, -1 + 0x1p-53, 1 - 0x1p-53},  // nor are -1 and 1
};

}  // namespace

std::span<const ScalarFormula> scalar_formulas() { return kScalarFormulas; }

}  // namespace catena::field
