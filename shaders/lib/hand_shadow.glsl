// SPDX-License-Identifier: MIT
// Shadow of the haptic cursors on what is behind them, analytically: the share of each light's disc that spheres, cylinders and cones
// cover, seen from a point. The includer declares opaque_depth. Only tiles that hand_mask.frag finds are drawn: a CPU driver executes all
// branches for all pixels.
#include "shaders/lib/hand_parts.glsl"
#include "shaders/lib/lighting.glsl"
#include "shaders/lib/light_grid.glsl"

#define PI 3.14159265
#define NEARLY_STRAIGHT 8.0  // an edge of a sphere of so many radii of the light's disc is taken as a straight line

// Returns the share of the unit disc at x' < x.
float disc_share(float x) {
  x = clamp(x, -1.0, 1.0);
  return 0.5 + (x * sqrt(1.0 - x * x) + asin(x)) / PI;
}

// Returns the share of the unit disc that a disc of radius r at distance d covers.
float covered_by_disc(float r, float d) {
  if (d >= 1.0 + r) return 0.0;
  if (r > NEARLY_STRAIGHT) return disc_share(r - d);
  if (d <= abs(1.0 - r)) return min(1.0, r * r);
  const float a = (d * d + r * r - 1.0) / (2.0 * d * r), b = (d * d + 1.0 - r * r) / (2.0 * d);
  const float kite = (1.0 + r - d) * (d + r - 1.0) * (d + 1.0 - r) * (d + 1.0 + r);
  return (r * r * acos(clamp(a, -1.0, 1.0)) + acos(clamp(b, -1.0, 1.0)) - 0.5 * sqrt(max(kite, 0.0))) / PI;
}

// Returns the share of a light's disc that a part covers, seen from `view`. `to_light`: unit vector; `tangent`: of the disc's radius;
// `sharp`: least width of the penumbra. At the part's distance the disc is the circle of radius `disc` about the point's projection.
float covered_by_part(vec4 from, vec4 to, vec3 view, vec3 to_light, float tangent, float sharp) {
  const vec3 a = from.xyz - view, b = to.xyz - view;
  const float height_a = dot(a, to_light), height_b = dot(b, to_light);
  const vec3 flat_a = a - height_a * to_light, axis = b - height_b * to_light - flat_a;
  const float axis_length = length(axis);
  if (axis_length < 0.1 * max(from.w, to.w)) {
    const float height = max(height_a, height_b), disc = length(vec2(tangent * height, sharp));
    return height > 0.0 ? covered_by_disc(max(from.w, to.w) / disc, length(flat_a) / disc) : 0.0;
  }
  const vec3 along = axis / axis_length;
  const float place = -dot(flat_a, along), t = clamp(place / axis_length, 0.0, 1.0);
  const float height = mix(height_a, height_b, t), radius = mix(from.w, to.w, t), disc = length(vec2(tangent * height, sharp));
  const float aside = length(flat_a + place * along);
  const float across = disc_share((radius - aside) / disc) - disc_share((-radius - aside) / disc);
  return height > 0.0 ? across * (disc_share((axis_length - place) / disc) - disc_share(-place / disc)) : 0.0;
}

// Returns the shares of the first three lights that the hand lets through to a point in view axes.
vec3 passing_shares(vec3 view) {
  vec3 shares = vec3(1.0);
  const float sharp = pixel_width(view);
  for (uint k = 0u; k < hand.part_count; ++k)
    for (int i = 0; i < 3; ++i)
      if (hand.light_tangents[i] >= 0.0)
        shares[i] *= 1.0 - covered_by_part(hand.from[k], hand.to[k], view, frame.lights[i].direction, hand.light_tangents[i], sharp);
  return shares;
}

vec3 camera_direction(vec3 view) { return mix(-normalize(view), vec3(0.0, 0.0, -1.0), float(frame.orthographic)); }

// Returns the factor on the light of a point, by the light that arrives there without the hand.
vec3 shadow_factor(vec3 all, vec3 rest) { return mix(rest / max(all, 1e-6), vec3(1.0), lessThan(all, vec3(1e-6))); }

// Returns the difference of the positions of a pixel and of its neighbor in direction s, or of the other one, whose depth is nearer.
vec3 along_surface(ivec2 p, ivec2 s, vec3 view, float t) {
  const ivec2 last = textureSize(opaque_depth, 0) - 1;
  const ivec2 a = clamp(p + s, ivec2(0), last), b = clamp(p - s, ivec2(0), last);
  const float after = texelFetch(opaque_depth, a, 0).r, before = texelFetch(opaque_depth, b, 0).r;
  const bool forwards = a != p && (b == p || abs(after - t) <= abs(before - t));
  return forwards ? view_position(vec2(a) + 0.5, after) - view : view - view_position(vec2(b) + 0.5, before);
}

// Returns the factor by which the hand's shadow darkens what is opaque.
vec3 hand_on_opaque(ivec2 p) {
  const float t = texelFetch(opaque_depth, p, 0).r;
  if (t >= NO_DEPTH) return vec3(1.0);
  const vec3 view = view_position(vec2(p) + 0.5, t), to_camera = camera_direction(view);
  vec3 normal = normalize(cross(along_surface(p, ivec2(1, 0), view, t), along_surface(p, ivec2(0, 1), view, t)));
  if (dot(normal, to_camera) < 0.0) normal = -normal;
  receive_on_surface(frame.light_grid.from_view * view + frame.light_grid.origin, normal, to_camera);
  const vec3 all = lighting_of(normal, to_camera).diffuse;
  arriving.rgb *= passing_shares(view);
  return shadow_factor(all, lighting_of(normal, to_camera).diffuse);
}

// Returns the factor by which the hand's shadow darkens volumes, at the depth at which they are half opaque.
vec3 hand_on_volume(ivec2 p) {
  const float t = half_opacity_depth(p);
  if (t >= NO_DEPTH) return vec3(1.0);
  const vec3 view = view_position(vec2(p) + 0.5, t), to_camera = camera_direction(view);
  receive_in_front(frame.light_grid.from_view * view + frame.light_grid.origin, to_camera, 1);
  const vec3 all = scattered_light(0.0, to_camera).diffuse;
  arriving.rgb *= passing_shares(view);
  return shadow_factor(all, scattered_light(0.0, to_camera).diffuse);
}
