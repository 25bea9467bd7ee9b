// A left ventricle by formula: a truncated ellipsoidal shell around the long axis z, base up, apex down.
//   e(x)     = sqrt((x^2 + y^2) / a^2 + z^2 / c^2), a = 1, c = 1.5
//   t(x)     = (e - 0.75) / 0.4: transmural depth, 0 at the endocardium, 1 at the epicardium (it goes on beyond them)
//   density  = 1 in the wall (0 <= t <= 1, z <= 0.8), falling as a cubic to 0 over 0.25 of the thickness at either side and
//              over 0.1 above the base
//   fibre    = cos(h) circumferential + sin(h) longitudinal, helix angle h = 60 - 120 t degrees; unit length, in the tangent
//              plane of the shell through the point. Circumferential is (-y, x, 0) / r, longitudinal is up along the wall.
//              Zero outside the support of the density and on the long axis, where no direction is circumferential.
#include <numbers>

#include "engine/field/analytic_formula.h"

namespace catena::field {
namespace {

constexpr double a2 = 1.0, c2 = 1.5 * 1.5;
constexpr double endocardium = 0.75, thickness = 0.4;
constexpr double side_margin = 0.25, base_z = 0.8, base_margin = 0.1;

/// 1 for u <= 0, 0 for u >= 1, a cubic with flat ends between.
double fall(double u, double& slope) {
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
  const double side = fall((inner ? -t : t - 1) / side_margin, side_slope);
  const double base = fall((p.z - base_z) / base_margin, base_slope);
  gradient = depth_gradient * (base * side_slope * (inner ? -1 : 1) / side_margin) + Vec3(0, 0, side * base_slope / base_margin);
  return side * base;
}

bool ventricle_fibre(const Vec3& p, Vec3& fibre) {
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
