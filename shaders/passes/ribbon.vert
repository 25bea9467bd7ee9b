// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/frame.h"
#include "shaders/shared/tube.h"

layout(scalar, binding = 0) uniform Frame { MeshFrameData frame; };
layout(scalar, binding = 1) readonly buffer Rings { TubeRingData rings[]; };
#include "shaders/lib/vertex_transform.glsl"
#include "shaders/lib/rings.glsl"
layout(location = 0) out vec4 out_tangent;  // tangent in view axes; position across the tube, -1 .. 1
layout(location = 1) out vec4 out_color;    // color and depth
layout(location = 2) flat out uint out_id;
layout(location = 3) out float out_inside;  // < 0: the wall towards the camera is clipped

#define OUTLINE_HEIGHT 0.57  // radii from the axis to the wall at the outline; the mean with 1 at the ridge is that of a circle, pi / 4

// A thin tube as a prism: each ring has two vertices at the outline and one at the ridge, one radius towards the camera, so that touching
// tubes occlude each other like round ones.
void main() {
  const TubeRingData ring = rings[gl_VertexIndex >> RING_SHIFT];
  const float across = float(gl_VertexIndex & 3) * (2.0 / RIBBON_WALLS) - 1.0;
  const vec3 tangent = unpack_direction(ring.tangent);
  const vec3 center = frame.view_from_world * ring.center + frame.offset;
  const vec3 to_camera = mix(-center, vec3(0.0, 0.0, -1.0), float(frame.orthographic)) * frame.view_from_world;
  // any direction, if the tube points along the line of sight
  const vec3 lateral = to_camera - dot(to_camera, tangent) * tangent;
  const vec3 other = abs(tangent.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
  const bool is_oblique = dot(lateral, lateral) > 1.0e-8 * dot(to_camera, to_camera);
  const vec3 front = normalize(is_oblique ? lateral : other - dot(other, tangent) * tangent);
  const vec3 middle = ring.center + ring.radius * across * cross(tangent, front);
  const vec3 wall = ring.radius * mix(1.0, OUTLINE_HEIGHT, abs(across)) * front;
  const vec3 turned = transform_vertex(middle + ring.radius * (1.0 - abs(across)) * normalize(to_camera), middle, wall, ring.id, out_inside);
  out_tangent = vec4(frame.view_from_world * tangent, across);
  out_color = vec4(ring_color(ring.color), turned.z + frame.offset_depth);
  out_id = ring.id & ID_MASK;
  // clips the walls to a gap ring
  if ((ring.color & RING_GAP) != 0u) gl_ClipDistance[0] = -1.0e30;
}
