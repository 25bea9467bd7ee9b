// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/frame.h"

layout(scalar, binding = 0) uniform Frame { MeshFrameData frame; };
#include "shaders/lib/lighting.glsl"
#include "shaders/lib/light_grid.glsl"
layout(location = 0) flat in vec3 in_center;
layout(location = 1) flat in float in_radius;
layout(location = 2) flat in vec3 in_color;
layout(location = 3) flat in uint in_id;
layout(location = 4) in vec3 in_view;
layout(location = 0) out vec4 out_color;
layout(location = 1) out float out_depth;
layout(location = 2) out uint out_id;

// Returns whether the clip planes keep a position in view axes.
bool is_inside_clip_planes(vec3 view, float counts) {
  const vec3 position = (view - frame.offset) * frame.view_from_world;  // the inverse of a rotation is its transpose
  float lowest = 0.0;
  for (int i = 0; i < MAX_CLIP_PLANES; ++i) lowest = min(lowest, counts * (dot(frame.clips[i].xyz, position) + frame.clips[i].w));
  return lowest >= 0.0;
}

void main() {
  const float flat_view = float(frame.orthographic);
  const vec3 ray = normalize(mix(in_view, vec3(0.0, 0.0, 1.0), flat_view));
  // solves |c + s ray - center| = radius, from the ray's nearest point to the center
  const vec3 off = in_view - in_center, across = off - dot(off, ray) * ray;
  const float root = in_radius * in_radius - dot(across, across);
  const float half_chord = sqrt(max(root, 0.0)), counts = (in_id & UNCLIPPED) == 0u ? 1.0 : 0.0;
  const vec3 front = across - half_chord * ray, back = across + half_chord * ray;
  const bool front_visible = is_inside_clip_planes(in_center + front, counts);
  if (root < 0.0 || !(front_visible || is_inside_clip_planes(in_center + back, counts))) discard;
  const vec3 normal = front_visible ? front : back, view = in_center + normal;
  const vec3 to_camera = mix(-ray, vec3(0.0, 0.0, -1.0), flat_view);
  const float depth = view.z + frame.offset_depth - frame.offset.z;
  receive_on_surface(frame.light_grid.from_view * view + frame.light_grid.origin, normal, to_camera);
  out_color = vec4(fogged(lit(vertex_color(in_color), normal, to_camera), depth), 1.0);
  out_depth = depth;
  out_id = in_id & ID_MASK;
  gl_FragDepth = mix(frame.depth_near / max(view.z, 1e-30), (frame.depth_far - view.z) / (frame.depth_far - frame.depth_near), flat_view);
}
