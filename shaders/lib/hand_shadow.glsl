// SPDX-License-Identifier: MIT
// Shadow of the haptic cursors on what is behind them, analytically: the share of each light's disc that spheres, cylinders and cones
// cover, seen from a point. The includer declares opaque_depth.
#include "shaders/shared/hand_shadow.h"
layout(scalar, binding = 6) uniform Frame { MeshFrameData frame; };
layout(scalar, binding = 7) uniform Hand { HandShadowData hand; };
layout(binding = 8) uniform texture2D volume_depth;
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
  const float sharp = hand.pixel * mix(view.z, 1.0, float(frame.orthographic));
  const vec3 middle = hand.whole.xyz - view;
  for (uint i = 0u; i < 3u; ++i) {
    const vec3 to_light = frame.lights[i].direction;
    const float tangent = hand.light_tangents[i], height = dot(middle, to_light);
    const float reach = hand.whole.w + max(tangent, 0.0) * (height + hand.whole.w) + sharp;
    const bool near = tangent >= 0.0 && height > -hand.whole.w && length(middle - height * to_light) < reach;
    const uint count = near ? hand.part_count : 0u;
    for (uint k = 0u; k < count; ++k)
      shares[i] *= 1.0 - covered_by_part(hand.from[k], hand.to[k], view, to_light, tangent, sharp);
  }
  return shares;
}

// Returns the position of pixel coordinates `at` at depth t in view axes.
vec3 view_position(vec2 at, float t) {
  const float z = t - frame.offset_depth, per_depth = mix(z, 1.0, float(frame.orthographic));
  const vec2 window = (at * frame.pixel - 1.0 - frame.shift) * per_depth / frame.scale;
  return vec3(window.x, -window.y, z);
}

vec3 camera_direction(vec3 view) { return mix(-normalize(view), vec3(0.0, 0.0, -1.0), float(frame.orthographic)); }

// Returns the factor on the light of a point, by the light that arrives there without the hand.
vec3 shadow_factor(vec3 shares, vec3 all, vec3 rest) { return mix(rest / max(all, 1e-6), vec3(1.0), lessThan(all, vec3(1e-6))); }

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
  const vec3 view = view_position(vec2(p) + 0.5, t), shares = passing_shares(view);
  if (shares == vec3(1.0)) return vec3(1.0);
  const vec3 to_camera = camera_direction(view);
  vec3 normal = normalize(cross(along_surface(p, ivec2(1, 0), view, t), along_surface(p, ivec2(0, 1), view, t)));
  if (dot(normal, to_camera) < 0.0) normal = -normal;
  receive_on_surface(frame.light_grid.from_view * view + frame.light_grid.origin, normal, to_camera);
  const vec3 all = lighting_of(normal, to_camera).diffuse;
  arriving.rgb *= shares;
  return shadow_factor(shares, all, lighting_of(normal, to_camera).diffuse);
}

// Returns the depth at which volumes are half opaque: the mean of the texels around that have one; NO_DEPTH if none has.
float half_opacity_depth(ivec2 p) {
  const ivec2 lo = ivec2(hand.first_x, hand.first_y), hi = ivec2(hand.last_x, hand.last_y);
  const vec2 place = vec2(p) / hand.volume_spacing;
  const ivec2 corner = ivec2(floor(place));
  const vec2 share = place - vec2(corner);
  vec2 sum = vec2(0.0);
  for (int k = 0; k < 4; ++k) {
    const ivec2 at = ivec2(k & 1, k >> 1);
    const float t = texelFetch(volume_depth, clamp(corner + at, lo, hi), 0).r;
    const vec2 weights = mix(1.0 - share, share, vec2(at));
    if (t < hand.depth_limit) sum += (weights.x * weights.y + 1e-6) * vec2(t, 1.0);
  }
  return sum.y > 0.0 ? sum.x / sum.y : NO_DEPTH;
}

// Returns the factor by which the hand's shadow darkens volumes, at the depth at which they are half opaque.
vec3 hand_on_volume(ivec2 p) {
  const float t = half_opacity_depth(p);
  if (t >= NO_DEPTH) return vec3(1.0);
  const vec3 view = view_position(vec2(p) + 0.5, t), shares = passing_shares(view);
  if (shares == vec3(1.0)) return vec3(1.0);
  const vec3 to_camera = camera_direction(view);
  receive_in_front(frame.light_grid.from_view * view + frame.light_grid.origin, to_camera, 1);
  const vec3 all = scattered_light(0.0, to_camera).diffuse;
  arriving.rgb *= shares;
  return shadow_factor(shares, all, scattered_light(0.0, to_camera).diffuse);
}
