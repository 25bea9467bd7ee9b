#include "engine/scene/color_spaces.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace catena::scene {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kWhiteX = 0.9505, kWhiteZ = 1.089;  // D65, Y = 1
constexpr double kUnsaturated = 0.05;                // in s: below it a hue says nothing
constexpr double kLeastWhite = 88;

double linear_of(double v) { return v > 0.04045 ? std::pow((v + 0.055) / 1.055, 2.4) : v / 12.92; }
double encoded(double v) { return v > 0.0031308 ? 1.055 * std::pow(v, 1 / 2.4) - 0.055 : 12.92 * v; }

double lab_curve(double v) { return v > 216.0 / 24389 ? std::cbrt(v) : (24389.0 / 27 * v + 16) / 116; }
double lab_curve_back(double v) { return v * v * v > 216.0 / 24389 ? v * v * v : (116 * v - 16) * 27 / 24389; }

/// The hue of a saturated colour as it nears white of length `white`.
double turned_hue(const Vec3& msh, double white) {
  if (msh.x >= white) return msh.z;
  const double spin = msh.y * std::sqrt(white * white - msh.x * msh.x) / (msh.x * std::sin(msh.y));
  return msh.z > -kPi / 3 ? msh.z + spin : msh.z - spin;
}

double angle_between(double a, double b) {
  const double d = std::fabs(std::remainder(a - b, 2 * kPi));
  return d;
}

Vec3 diverging(Vec3 a, Vec3 b, double t) {
  const bool apart = a.y > kUnsaturated && b.y > kUnsaturated && angle_between(a.z, b.z) > kPi / 3;
  if (apart) {
    const Vec3 white(std::max({a.x, b.x, kLeastWhite}), 0.0, 0.0);
    (t < 0.5 ? b : a) = white;
    t = t < 0.5 ? 2 * t : 2 * t - 1;
  }
  if (a.y < kUnsaturated && b.y > kUnsaturated)
    a.z = turned_hue(b, a.x);
  else if (b.y < kUnsaturated && a.y > kUnsaturated)
    b.z = turned_hue(a, b.x);
  return (1 - t) * a + t * b;
}

Vec3 hsv_from_rgb(const Vec3& c) {
  const double most = std::max({c.x, c.y, c.z}), span = most - std::min({c.x, c.y, c.z});
  double hue = 0;
  if (span > 0) {
    if (most == c.x)
      hue = std::fmod((c.y - c.z) / span + 6, 6);
    else
      hue = most == c.y ? 2 + (c.z - c.x) / span : 4 + (c.x - c.y) / span;
  }
  return {hue / 6, most > 0 ? span / most : 0, most};
}

Vec3 rgb_from_hsv(const Vec3& c) {
  const auto component = [&](double n) {
    const double k = std::fmod(n + 6 * c.x, 6);
    return c.z * (1 - c.y * std::clamp(std::min(k, 4 - k), 0.0, 1.0));
  };
  return {component(5), component(3), component(1)};
}

Vec3 hsv_between(const Vec3& a, const Vec3& b, double t, bool wrap) {
  const double turn = wrap ? std::remainder(b.x - a.x, 1.0) : b.x - a.x, hue = a.x + t * turn;
  return {hue - std::floor(hue), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
}

}  // namespace

Vec3 lab_from_srgb(const Vec3& rgb) {
  const double r = linear_of(rgb.x), g = linear_of(rgb.y), b = linear_of(rgb.z);
  const double x = lab_curve((0.4124 * r + 0.3576 * g + 0.1805 * b) / kWhiteX), y = lab_curve(0.2126 * r + 0.7152 * g + 0.0722 * b),
               z = lab_curve((0.0193 * r + 0.1192 * g + 0.9505 * b) / kWhiteZ);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Vec3 srgb_from_lab(const Vec3& lab) {
  const double fy = (lab.x + 16) / 116;
  const double x = kWhiteX * lab_curve_back(fy + lab.y / 500), y = lab_curve_back(fy), z = kWhiteZ * lab_curve_back(fy - lab.z / 200);
  const Vec3 rgb(encoded(3.2406 * x - 1.5372 * y - 0.4986 * z), encoded(-0.9689 * x + 1.8758 * y + 0.0415 * z),
                 encoded(0.0557 * x - 0.2040 * y + 1.0570 * z));
  const double most = std::max({rgb.x, rgb.y, rgb.z, 1.0});
  return {std::max(rgb.x, 0.0) / most, std::max(rgb.y, 0.0) / most, std::max(rgb.z, 0.0) / most};
}

Vec3 msh_from_lab(const Vec3& lab) {
  const double m = norm(lab);
  return {m, m > 1e-3 ? std::acos(std::clamp(lab.x / m, -1.0, 1.0)) : 0, m > 1e-3 ? std::atan2(lab.z, lab.y) : 0};
}

Vec3 lab_from_msh(const Vec3& msh) {
  return {msh.x * std::cos(msh.y), msh.x * std::sin(msh.y) * std::cos(msh.z), msh.x * std::sin(msh.y) * std::sin(msh.z)};
}

Vec3 between_colors(ColorSpace space, const Vec3& a, const Vec3& b, double t) {
  switch (space) {
    case ColorSpace::rgb:
      return a + t * (b - a);
    case ColorSpace::hsv:
    case ColorSpace::hsv_wrap:
      return rgb_from_hsv(hsv_between(hsv_from_rgb(a), hsv_from_rgb(b), t, space == ColorSpace::hsv_wrap));
    case ColorSpace::lab:
      return srgb_from_lab((1 - t) * lab_from_srgb(a) + t * lab_from_srgb(b));
    case ColorSpace::diverging:
      return srgb_from_lab(lab_from_msh(diverging(msh_from_lab(lab_from_srgb(a)), msh_from_lab(lab_from_srgb(b)), t)));
  }
  return a;
}

}  // namespace catena::scene
