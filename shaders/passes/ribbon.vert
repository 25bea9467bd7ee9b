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
layout(location = 0) out vec4 out_tangent;  // view axes; and the place across the tube, -1 .. 1
layout(location = 1) out vec4 out_color;    // and the depth
layout(location = 2) flat out uint out_id;
layout(location = 3) out float out_inside;  // below zero: the wall towards the eye is cut away

#define OUTLINE_HEIGHT 0.57  // radii from the axis to the wall at the outline; with 1 at the ridge the mean is that of a circle, pi / 4

// A thin tube as a prism: of each ring two vertices of the outline and the ridge between them, one radius towards the eye, so that tubes
// that touch hide each other as round ones do.
void main() {
  const TubeRingData ring = rings[gl_VertexIndex >> RING_SHIFT];
  const float across = float(gl_VertexIndex & 3) * (2.0 / RIBBON_WALLS) - 1.0;
  const vec3 tangent = unpack_direction(ring.tangent);
  const vec3 center = frame.view_from_world * ring.center + frame.offset;
  const vec3 to_camera = mix(-center, vec3(0.0, 0.0, -1.0), float(frame.orthographic)) * frame.view_from_world;
  // along the line of sight any direction serves
  const vec3 aside = to_camera - dot(to_camera, tangent) * tangent;
  const vec3 other = abs(tangent.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
  const vec3 front = normalize(dot(aside, aside) > 1.0e-8 * dot(to_camera, to_camera) ? aside : other - dot(other, tangent) * tangent);
  const vec3 middle = ring.center + ring.radius * across * cross(tangent, front);
  const vec3 wall = ring.radius * mix(1.0, OUTLINE_HEIGHT, abs(across)) * front;
  const vec3 turned = transform_vertex(middle + ring.radius * (1.0 - abs(across)) * normalize(to_camera), middle, wall, ring.id, out_inside);
  out_tangent = vec4(frame.view_from_world * tangent, across);
  out_color = vec4(ring_color(ring.color), turned.z + frame.offset_depth);
  out_id = ring.id & ID_MASK;
  // the clip cuts what leads to a gap off where it begins
  if ((ring.color & RING_GAP) != 0u) gl_ClipDistance[0] = -1.0e30;
}
