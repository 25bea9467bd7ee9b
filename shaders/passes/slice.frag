// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// Plane through a grid: the value at the intersection with the pixel's ray, colored, with contour lines.
#include "shaders/shared/layers.h"
#define GRID_COUNT 1
#include "shaders/lib/grids.glsl"
#include "shaders/lib/rays.glsl"
#include "shaders/lib/lighting.glsl"
#include "shaders/lib/peel.glsl"

layout(scalar, binding = 1) uniform Slice { SliceData slice; };
layout(scalar, binding = 2) readonly buffer Colors { vec4 colors[]; };  // value, r, g, b
layout(scalar, binding = 4) readonly buffer Levels { float levels[]; };
layout(scalar, binding = 36) readonly buffer Texels { uvec2 texels[]; };  // a, b, c, presence as 16-bit fractions (engine/geometry/flow/lic.h)

// Intersection of the plane and the ray of pixel coordinate q, and its derivatives by pixel.
struct Hit {
  bool is_visible;
  float t, value;
  vec3 p;          // local position
  vec2 gradient;   // gradient of the value, per pixel
  vec2 slope;      // gradient of t, per pixel
};

vec3 table_color(float value) {
  uint a = 0u, b = slice.color_last;
  if (!(value > colors[a].x)) return colors[a].yzw;
  if (value >= colors[b].x) return colors[b].yzw;
  while (b - a > 1u) {
    const uint middle = (a + b) >> 1;
    if (colors[middle].x <= value) a = middle;
    else b = middle;
  }
  return mix(colors[a].yzw, colors[b].yzw, (value - colors[a].x) / max(colors[b].x - colors[a].x, 1e-37));
}

// Returns the value and its gradient in local axes (0 for nearest interpolation). Returns false for an invalid cell or a hidden value.
bool value_at(vec3 p, out float value, out vec3 gradient) {
  value = 0.0;
  gradient = vec3(0.0);
  const ivec3 cell = cell_of(0, p);
  if (empty_distance(brick_word(0, cell >> 3)) > 0) return false;
  if (grid_is_masked(0) && !cell_is_valid(0, cell)) return false;
  if (grid_is_cubic(0)) {
    value = frame.grids[0].value_offset + frame.grids[0].value_scale * cubic_value(fetch_cubic_at(0, p), gradient);
    gradient *= frame.grids[0].value_scale;
  } else {
    vec4 lo, hi;
    cell_corners(0, cell, lo, hi);
    const vec3 f = corner_weights(0, clamp(p - vec3(cell), 0.0, 1.0));
    const vec4 z = mix(lo, hi, f.z), along_z = hi - lo;
    const vec2 y = mix(z.xy, z.zw, f.y), along_y = z.zw - z.xy;
    const vec2 zy = mix(along_z.xy, along_z.zw, f.y);
    value = mix(y.x, y.y, f.x);
    gradient = (1.0 - frame.grids[0].nearest) * vec3(y.y - y.x, mix(along_y.x, along_y.y, f.x), mix(zy.x, zy.y, f.x));
  }
  const vec4 bounds = slice.threshold;
  const bool is_shown = (value >= bounds.x && value <= bounds.y) || (value >= bounds.z && value <= bounds.w);
  return is_shown && !(abs(value - slice.hidden_label) < 0.5);
}

bool is_clipped(vec2 q, float t) {
  const uint planes = as_nonuniform(frame.clip_count, gl_FragCoord.xy);
  for (uint i = 0u; i < planes; ++i) {
    const float at = frame.clips[i].at + frame.clips[i].at_x * q.x + frame.clips[i].at_y * q.y;
    const float along = frame.clips[i].along + frame.clips[i].along_x * q.x + frame.clips[i].along_y * q.y;
    if (at + t * along < -slice.clip_slack) return true;
  }
  return false;
}

#define SLOPE_BIAS 0.0078125  // pixels
#define FACE_SLACK 1e-3  // voxels; a plane in a face of the domain is drawn

Hit intersect_plane(vec2 q) {
  Hit hit;
  hit.value = 0.0;
  hit.gradient = hit.slope = vec2(0.0);
  const LocalRay ray = local_ray(0, q);
  const float at = slice.plane.at + slice.plane.at_x * q.x + slice.plane.at_y * q.y;
  const float along = slice.plane.along + slice.plane.along_x * q.x + slice.plane.along_y * q.y;
  hit.is_visible = abs(along) > MIN_DIRECTION;
  hit.t = hit.is_visible ? -at / along : NO_DEPTH;
  hit.is_visible = hit.is_visible && hit.t >= frame.front_depth && abs(hit.t) < NO_DEPTH;
  hit.p = ray.origin + (hit.is_visible ? hit.t : 0.0) * ray.direction;
  const vec3 lo = frame.grids[0].domain_lo, hi = frame.grids[0].domain_hi;
  hit.is_visible = hit.is_visible && all(greaterThanEqual(hit.p, lo - FACE_SLACK)) && all(lessThanEqual(hit.p, hi + FACE_SLACK));
  hit.p = clamp(hit.p, lo, hi);
  if (!hit.is_visible) return hit;
  vec3 local;
  hit.is_visible = value_at(hit.p, hit.value, local);
  // derivative of the intersection by pixel
  hit.slope = -(vec2(slice.plane.at_x, slice.plane.at_y) + hit.t * vec2(slice.plane.along_x, slice.plane.along_y)) / along;
  const vec3 x = frame.grids[0].origin_x + hit.t * frame.grids[0].direction_x + hit.slope.x * ray.direction;
  const vec3 y = frame.grids[0].origin_y + hit.t * frame.grids[0].direction_y + hit.slope.y * ray.direction;
  hit.gradient = vec2(dot(local, x), dot(local, y));
  return hit;
}

bool is_steep(Hit hit) { return any(greaterThan(abs(hit.gradient), vec2(0.0))); }

// Returns the offset in pixels to the level, by the value's tangent. Normalizes the gradient first: 1e24 or 1e-24 squared would leave the
// float range.
vec2 offset_to(Hit hit, float level) {
  const float size = max(abs(hit.gradient.x), abs(hit.gradient.y));
  const vec2 along = hit.gradient / size;
  return (level - hit.value) / size / dot(along, along) * along;
}

// Returns a contour line's coverage of the pixel. The line's distance is that of the foot point on the value's tangent, corrected at that
// point (the value is curved, and its gradient is discontinuous between cells).
float line_coverage(Hit hit, vec2 q, float level) {
  if (!is_steep(hit)) return 0.0;
  vec2 foot = offset_to(hit, level);
  if (length(foot) > slice.half_width + 2.0) return 0.0;
  const Hit there = intersect_plane(q + foot);
  if (there.is_visible && is_steep(there)) {
    const vec2 more = offset_to(there, level);
    if (length(more) < 1.0) foot += more;
  }
  return clamp(slice.half_width + 0.5 - length(foot), 0.0, 1.0) * min(1.0, 2.0 * slice.half_width);
}

float contour_coverage(Hit hit, vec2 q) {
  if (slice.level_count == 0u) return 0.0;
  uint a = 0u, b = slice.level_count;  // levels before a are at most the value, levels from b on are greater
  while (a < b) {
    const uint middle = (a + b) >> 1;
    if (levels[middle] <= hit.value) a = middle + 1u;
    else b = middle;
  }
  float cover = 0.0;
  if (a > 0u) cover = line_coverage(hit, q, levels[a - 1u]);
  if (a < slice.level_count) cover = max(cover, line_coverage(hit, q, levels[a]));
  return cover;
}

vec4 texel_at(uvec2 at) {
  const uvec2 packed = texels[at.y * slice.texture_width + at.x];
  return vec4(unpackSnorm2x16(packed.x), unpackSnorm2x16(packed.y));
}

float plane_distance(ClipData plane, vec2 q, float t) {
  return plane.at + plane.at_x * q.x + plane.at_y * q.y + t * (plane.along + plane.along_x * q.x + plane.along_y * q.y);
}

// Factor on the color at depth t: 1 + strength * (2 * texture - 1), the texture interpolated between texels.
float texture_factor(vec2 q, float t) {
  if (slice.texture_width == 0u) return 1.0;
  const vec2 size = vec2(slice.texture_width, slice.texture_height);
  const vec2 place = slice.texels_per_unit * vec2(plane_distance(slice.texture_u, q, t), plane_distance(slice.texture_v, q, t));
  const vec2 inside = clamp(place, vec2(0.0), size - 1.0001), f = fract(inside);
  const uvec2 at = uvec2(inside);
  const vec4 low = mix(texel_at(at), texel_at(at + uvec2(1u, 0u)), f.x), high = mix(texel_at(at + uvec2(0u, 1u)), texel_at(at + uvec2(1u)), f.x);
  const vec4 texel = mix(low, high, f.y);
  const float streak = clamp(texel.x + dot(texel.yz, slice.texture_phase), -0.5, 0.5);
  return 1.0 + 2.0 * slice.texture_strength * texel.w * streak;
}

void main() {
  const vec2 q = pixel_position();
  Hit hit = intersect_plane(q);
  if (hit.is_visible && frame.grids[0].is_clipped != 0u) hit.is_visible = !is_clipped(q, hit.t);
  vec3 color = vec3(0.0);
  float alpha = 0.0;
  if (hit.is_visible) {
    const float line = contour_coverage(hit, q);
    vec3 surface = min(texture_factor(q, hit.t) * table_color(hit.value), 1.0);
    if (slice.is_lit != 0u) surface = lit(surface, slice.normal, -normalize(world_direction(q)));
    color = mix(layer.opacity * fogged(surface, hit.t), fogged(slice.line_color, hit.t), line);
    alpha = mix(layer.opacity, 1.0, line);
  }
  // bias: rounding of both terms of the depth, also if their sum is small; and a GPU rounds triangle corners to 1/256 pixel, which shifts
  // the depth of triangles in this plane
  const float t = hit.t - slice.depth_bias * (abs(hit.t) + layer.reference_depth) - SLOPE_BIAS * (abs(hit.slope.x) + abs(hit.slope.y));
  write_fragment(hit.is_visible && alpha > 0.0, color, alpha, t, frame.grids[0].id);
}
