// SPDX-License-Identifier: MIT
// Parts of the hand that cast shadows, and points on which they may fall.
#include "shaders/shared/hand_shadow.h"
layout(scalar, binding = 6) uniform Frame { MeshFrameData frame; };
layout(scalar, binding = 7) uniform Hand { HandShadowData hand; };
layout(binding = 8) uniform texture2D volume_depth;

// Returns the position of pixel coordinates `at` at depth t in view axes.
vec3 view_position(vec2 at, float t) {
  const float z = t - frame.offset_depth, per_depth = mix(z, 1.0, float(frame.orthographic));
  const vec2 window = (at * frame.pixel - 1.0 - frame.shift) * per_depth / frame.scale;
  return vec3(window.x, -window.y, z);
}

// Returns half the width of a pixel at a position, world units.
float pixel_width(vec3 view) { return hand.pixel * mix(view.z, 1.0, float(frame.orthographic)); }

// Returns the depth at which volumes are half opaque: the mean of the texels around that have one; NO_DEPTH if none has.
float half_opacity_depth(ivec2 p) {
  const ivec2 lo = ivec2(hand.depth_x, hand.depth_y), hi = ivec2(hand.depth_last_x, hand.depth_last_y);
  const vec2 place = vec2(p) / float(DEPTH_SPACING);
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

// Returns whether a part can cover some of a light's disc, by the distance of its axis from the line to the light.
bool may_cover(vec4 from, vec4 to, vec3 view, vec3 to_light, float tangent, float sharp) {
  const vec3 a = from.xyz - view, axis = to.xyz - from.xyz;
  const float height_a = dot(a, to_light), height_axis = dot(axis, to_light), highest = height_a + max(height_axis, 0.0);
  const vec3 flat_a = a - height_a * to_light, flat_axis = axis - height_axis * to_light;
  const float t = clamp(-dot(flat_a, flat_axis) / max(dot(flat_axis, flat_axis), 1e-30), 0.0, 1.0);
  const float reach = max(from.w, to.w) + tangent * highest + sharp;
  const vec3 nearest = flat_a + t * flat_axis;
  return highest > 0.0 && dot(nearest, nearest) < reach * reach;
}
