// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/frame.h"
#include "shaders/shared/sphere.h"

layout(scalar, binding = 0) uniform Frame { MeshFrameData frame; };
layout(scalar, binding = 1) readonly buffer Spheres { SphereData spheres[]; };
layout(location = 0) flat out vec3 out_center;  // in view axes
layout(location = 1) flat out float out_radius;
layout(location = 2) flat out vec3 out_color;
layout(location = 3) flat out uint out_id;
layout(location = 4) out vec3 out_view;

// Square across the ray to the sphere's center, as wide there as the cone tangent to the sphere.
void main() {
  const SphereData sphere = spheres[gl_InstanceIndex];
  const vec3 center = frame.view_from_world * sphere.center + frame.offset;
  const float flat_view = float(frame.orthographic);
  const vec3 ahead = normalize(mix(center, vec3(0.0, 0.0, 1.0), flat_view));
  const vec3 side = normalize(abs(ahead.x) < 0.7 ? vec3(0.0, ahead.z, -ahead.y) : vec3(-ahead.z, 0.0, ahead.x));
  const float away2 = dot(center, center), r2 = sphere.radius * sphere.radius;
  const float wide = sphere.radius * mix(sqrt(away2 / max(away2 - r2, 0.01 * r2)), 1.0, flat_view);
  const int corner = gl_VertexIndex < 3 ? gl_VertexIndex : 6 - gl_VertexIndex;  // 0 1 2, 3 2 1
  const vec2 at = vec2((corner & 1) == 0 ? -wide : wide, (corner & 2) == 0 ? -wide : wide);
  const vec3 view = center + at.x * side + at.y * cross(ahead, side);
  out_center = center;
  out_radius = sphere.radius;
  out_color = vec3(sphere.color & 255u, sphere.color >> 8 & 255u, sphere.color >> 16 & 255u) / 255.0;
  out_id = sphere.id;
  out_view = view;
  const vec2 clip = vec2(view.x * frame.scale.x, -view.y * frame.scale.y) + frame.shift * mix(view.z, 1.0, flat_view);
  const float depth = (frame.depth_far - view.z) / (frame.depth_far - frame.depth_near);
  gl_Position = vec4(clip, mix(frame.depth_near, depth, flat_view), mix(view.z, 1.0, flat_view));
}
