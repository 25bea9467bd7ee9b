// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// Coverage from the signed distance to the shape's edge, half a pixel to either side; premultiplied, blended over the image.
#include "shaders/shared/overlay.h"

layout(scalar, binding = 1) readonly buffer Shapes { OverlayShape shapes[]; };
layout(scalar, binding = 2) readonly buffer Stops { OverlayStop stops[]; };
layout(binding = 3) uniform texture2D atlas;
layout(location = 0) in vec2 in_local;
layout(location = 1) flat in uint in_shape;
layout(location = 0) out vec4 out_color;

float box_distance(vec2 p, vec4 size) {
  const vec2 q = abs(p) - size.xy + size.z;
  return length(max(q, 0.0)) + min(max(q.x, q.y), 0.0) - size.z;
}

float cone_distance(vec2 p, vec2 size) {
  const vec2 along = normalize(vec2(size.x, -size.y));
  return max(-p.x, dot(vec2(p.x, abs(p.y) - size.y), vec2(-along.y, along.x)));
}

float ellipse_distance(vec2 p, vec2 size) {
  const float k = length(p / size), slope = length(p / (size * size));
  return slope > 0.0 ? k * (k - 1.0) / slope : -min(size.x, size.y);
}

vec3 ramp(uint first, uint last, float position) {
  uint i = first;
  while (i < last && stops[i + 1].position < position) ++i;
  if (i == last || position <= stops[i].position) return stops[i].color;
  return mix(stops[i].color, stops[i + 1].color, (position - stops[i].position) / (stops[i + 1].position - stops[i].position));
}

// light from above left; `across`: component of the normal in the image, y down
vec3 lit_round(vec3 color, vec2 across) {
  const vec3 normal = vec3(across, sqrt(max(0.0, 1.0 - dot(across, across))));
  const float diffuse = max(0.0, dot(normal, vec3(-0.40, -0.52, 0.755)));
  const float shine = pow(max(0.0, dot(normal, vec3(-0.214, -0.278, 0.936))), 40.0);
  return min(color * (0.38 + 0.68 * diffuse) + 0.25 * shine, vec3(1.0));
}

void main() {
  const OverlayShape s = shapes[in_shape];
  vec3 color = s.color.rgb;
  float coverage = 1.0;
  if (s.kind == OVERLAY_GLYPH) {
    coverage = texelFetch(atlas, ivec2(s.texel + floor(in_local - s.lo)), 0).r;
  } else {
    float d;
    if (s.kind == OVERLAY_CONE) {
      d = cone_distance(in_local, s.size.xy);
      const float half_width = max(s.size.y * (1.0 - in_local.x / s.size.x), 1e-3);
      color = lit_round(color, clamp(in_local.y / half_width, -1.0, 1.0) * s.axis_y);
    } else if (s.kind == OVERLAY_ELLIPSE) {
      d = ellipse_distance(in_local, s.size.xy);
      if (s.size.z > 0.0) {
        const vec2 at = in_local / s.size.xy;
        color = lit_round(color, (at.x * s.axis_x + at.y * s.axis_y) / max(1.0, length(at)));
      }
    } else {
      d = box_distance(in_local, s.size);
      if (s.size.w > 0.0) d = abs(d + 0.5 * s.size.w) - 0.5 * s.size.w;
      if (s.kind == OVERLAY_RAMP) color = ramp(s.first_stop, s.last_stop, 0.5 + 0.5 * in_local.x / s.size.x);
      if (s.kind == OVERLAY_TUBE) color = lit_round(color, clamp(in_local.y / s.size.y, -1.0, 1.0) * s.axis_y);
    }
    coverage = clamp(0.5 - d, 0.0, 1.0);
  }
  const float alpha = s.color.a * coverage;
  out_color = vec4(alpha * color, alpha);
}
