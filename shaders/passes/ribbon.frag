// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/frame.h"

layout(scalar, binding = 0) uniform Frame { MeshFrameData frame; };
#include "shaders/lib/lighting.glsl"
#include "shaders/lib/light_grid.glsl"
layout(location = 0) in vec4 in_tangent;
layout(location = 1) in vec4 in_color;
layout(location = 2) flat in uint in_id;
layout(location = 3) in float in_inside;
layout(location = 0) out vec4 out_color;
layout(location = 1) out float out_depth;
layout(location = 2) out uint out_id;

// Ribbon, shaded as the round tube that it represents; where it is cut open, as the inner side of the tube's rear wall.
void main() {
  const vec2 slope = (gl_FragCoord.xy * frame.pixel - 1.0 - frame.shift) / frame.scale;
  const vec3 to_camera = mix(normalize(vec3(-slope.x, slope.y, -1.0)), vec3(0.0, 0.0, -1.0), float(frame.orthographic));
  const vec3 tangent = normalize(in_tangent.xyz);
  const vec3 lateral = to_camera - dot(to_camera, tangent) * tangent;
  const vec3 front = lateral * inversesqrt(max(dot(lateral, lateral), 1.0e-12));
  const float across = clamp(in_tangent.w, -1.0, 1.0) * (in_inside < 0.0 ? -1.0 : 1.0);
  // view axes are left-handed: the cross product has the opposite sign of the vertex shader's, in world axes
  const vec3 normal = sqrt(1.0 - across * across) * front - across * cross(tangent, front);
  // the position on the ribbon, in view axes
  const float depth = in_color.w - frame.offset_depth + frame.offset.z;
  const vec3 view = vec3(slope.x, -slope.y, 1.0) * vec3(vec2(mix(depth, 1.0, float(frame.orthographic))), depth);
  receive_on_surface(frame.light_grid.from_view * view + frame.light_grid.origin, normal, to_camera);
  out_color = vec4(fogged(lit(vertex_color(in_color.rgb), normal, to_camera), in_color.w), 1.0);
  out_depth = in_color.w;
  out_id = in_id;
}
