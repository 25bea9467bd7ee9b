// SPDX-License-Identifier: MIT
#include "render/passes/cursor_parts.h"

#include <algorithm>
#include <cmath>

#include "render/passes/shapes.h"

namespace catena::render {

Color link_color(std::size_t i, bool active) {
  static constexpr Color kSequence[8] = {{0.90f, 0.62f, 0.00f}, {0.34f, 0.71f, 0.91f}, {0.00f, 0.62f, 0.45f}, {0.94f, 0.89f, 0.26f},
                                         {0.80f, 0.47f, 0.65f}, {0.84f, 0.37f, 0.00f}, {0.00f, 0.45f, 0.70f}, {0.60f, 0.60f, 0.60f}};
  const Color c = kSequence[i % 8];
  return active ? c : Color{0.4f * c.r, 0.4f * c.g, 0.4f * c.b};
}

Color release_color(double leaving) {
  constexpr Color on{0.65f, 0.65f, 0.65f}, near{0.90f, 0.62f, 0.00f}, gone{0.84f, 0.15f, 0.00f};
  const auto t = static_cast<float>(std::clamp(leaving, 0.0, 1.0));
  const auto mix = [](const Color& a, const Color& b, float f) {
    return Color{a.r + (b.r - a.r) * f, a.g + (b.g - a.g) * f, a.b + (b.b - a.b) * f};
  };
  return t < 0.5f ? mix(on, near, 2 * t) : mix(near, gone, 2 * t - 1);
}

double cursor_arrow_length(double force_n, double size) {
  if (!(force_n > 1e-9) || !(size > 0)) return 0;
  return size * std::clamp(2.5 * force_n, 2.0, 16.0);
}

namespace {

struct Parts {
  std::vector<CursorPart> list;
  void sphere(const Vec3& at, double radius, const Color& color) { list.push_back({CursorPart::Kind::sphere, at, at, radius, color}); }
  void cylinder(const Vec3& from, const Vec3& to, double radius, const Color& color) {
    list.push_back({CursorPart::Kind::cylinder, from, to, radius, color});
  }
  void cone(const Vec3& base, const Vec3& tip, double radius, const Color& color) {
    list.push_back({CursorPart::Kind::cone, base, tip, radius, color});
  }
  void rings(const Vec3& at, double radius, double thickness, const Color& color) {
    list.push_back({CursorPart::Kind::rings, at, at, radius, color, thickness, false});
  }
};

/// Interpolates blue, amber and red for a force ratio of 0, 0.5 and 1.
Color strain_color(double strain) {
  const auto share = static_cast<float>(std::clamp(strain, 0.0, 1.0));
  const Color calm{0.35f, 0.72f, 1.0f}, amber{1.0f, 0.75f, 0.2f}, red{1.0f, 0.15f, 0.1f};
  const bool low = share < 0.5f;
  const Color &a = low ? calm : amber, &b = low ? amber : red;
  const float t = low ? 2 * share : 2 * share - 1;
  return {a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b)};
}

/// Adds the arrow of the force at its point of application.
void add_force(Parts& parts, const CursorItem& cursor, const Vec3& from) {
  const Color lime{0.60f, 0.95f, 0.25f};
  const double length = is_finite(cursor.force_n) ? cursor_arrow_length(norm(cursor.force_n), cursor.radius) : 0;
  if (!(length > 0)) return;
  const Vec3 along = direction(cursor.force_n), tip = from + length * along, neck = tip - 1.1 * cursor.radius * along;
  parts.cylinder(from, neck, 0.25 * cursor.radius, lime);
  parts.cone(neck, tip, 0.55 * cursor.radius, lime);
}

/// Adds a pseudo-haptic cursor: a ball at the last proxy, with a tether to the probe that lags behind.
void add_pseudo_haptic(Parts& parts, const CursorItem& cursor) {
  Vec3 held = cursor.probe, before = cursor.probe;
  const Color color = strain_color(*cursor.force_ratio);
  const double tether = (0.12 + 0.3 * std::clamp(*cursor.force_ratio, 0.0, 1.0)) * cursor.radius;
  for (std::size_t i = 0; i < cursor.proxies.size(); ++i) {
    if (!is_finite(cursor.proxies[i])) continue;
    const bool active = i < cursor.link_active.size() && cursor.link_active[i];
    const double leaving = i < cursor.release_ratios.size() ? cursor.release_ratios[i] : 0;
    if (!active && leaving >= 1) parts.rings(cursor.proxies[i], cursor.radius * 1.5, 0.12 * cursor.radius, release_color(1));
    if (!active) continue;
    held = cursor.proxies[i];
    parts.cylinder(before, held, tether, color);
    if (held != before) parts.sphere(held, 0.5 * cursor.radius, link_color(i, true));
    before = held;
  }
  // white without a force; reaches the force color at 1/8 of the maximum, because a force along the view hides the tether behind the ball
  const Color calm{0.95f, 0.95f, 0.95f};
  const auto t = static_cast<float>(std::clamp(8 * *cursor.force_ratio, 0.0, 1.0));
  parts.sphere(held, cursor.radius, {calm.r + t * (color.r - calm.r), calm.g + t * (color.g - calm.g), calm.b + t * (color.b - calm.b)});
  add_force(parts, cursor, held);
  if (held != cursor.probe) parts.sphere(cursor.probe, 0.45 * cursor.radius, {0.6f, 0.62f, 0.66f});
}

/// Adds a line from the probe to its foot, and a cross there; neither casts a shadow.
void add_drop_line(Parts& parts, const CursorItem& cursor) {
  if (!is_finite(*cursor.foot_point) || *cursor.foot_point == cursor.probe) return;
  const Color grey{0.62f, 0.62f, 0.62f};
  const double radius = 0.15 * cursor.radius, reach = 1.5 * cursor.radius;
  parts.cylinder(cursor.probe, *cursor.foot_point, radius, grey);
  const Vec3 down = direction(*cursor.foot_point - cursor.probe), one = any_perpendicular(down), other = cross(down, one);
  for (const Vec3& arm : {one, other}) parts.cylinder(*cursor.foot_point - reach * arm, *cursor.foot_point + reach * arm, radius, grey);
  for (CursorPart& part : parts.list) part.casts = false;
}

/// Adds a cross along the world axes; dark and thin, to be visible on bright backgrounds and on lines.
void add_crosshair(Parts& parts, const CursorItem& cursor) {
  const Color dark{0.05f, 0.05f, 0.08f};
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 arm(0.0);
    arm[axis] = cursor.radius;
    parts.cylinder(cursor.probe - arm, cursor.probe + arm, 0.06 * cursor.radius, dark);
  }
}

/// Adds the probe, the proxies and the force.
void add_chain(Parts& parts, const CursorItem& cursor) {
  const Color white{0.95f, 0.95f, 0.95f};
  parts.sphere(cursor.probe, cursor.radius, white);

  // each proxy, joined to the previous one; decreasing radii avoid z-fighting of balls at one position
  Vec3 before = cursor.probe;
  for (std::size_t i = 0; i < cursor.proxies.size(); ++i) {
    if (!is_finite(cursor.proxies[i])) continue;
    const bool active = i < cursor.link_active.size() && cursor.link_active[i];
    const double radius = cursor.radius * (0.9 - 0.03 * static_cast<double>(std::min<std::size_t>(i, 8)));
    parts.sphere(cursor.proxies[i], radius, link_color(i, active));
    const double leaving = i < cursor.release_ratios.size() ? cursor.release_ratios[i] : 0;
    parts.cylinder(before, cursor.proxies[i], (0.18 + 0.2 * std::clamp(leaving, 0.0, 1.0)) * cursor.radius,
                   active ? release_color(leaving) : Color{0.3f, 0.3f, 0.3f});
    if (!active && leaving >= 1)
      parts.rings(cursor.proxies[i], cursor.radius * (1.5 + 0.35 * static_cast<double>(i)), 0.12 * cursor.radius, release_color(1));
    before = cursor.proxies[i];
  }

  add_force(parts, cursor, cursor.probe);
}

}  // namespace

std::vector<CursorPart> cursor_parts(const CursorItem& cursor) {
  Parts parts;
  if (!(cursor.radius > 0) || !is_finite(cursor.probe)) return {};
  if (cursor.foot_point) add_drop_line(parts, cursor);
  if (cursor.is_crosshair)
    add_crosshair(parts, cursor);
  else if (cursor.force_ratio)
    add_pseudo_haptic(parts, cursor);
  else
    add_chain(parts, cursor);
  return parts.list;
}

}  // namespace catena::render
