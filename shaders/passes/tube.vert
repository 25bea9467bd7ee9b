// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/shared/frame.h"
#include "shaders/shared/tube.h"

layout(scalar, binding = 0) uniform Frame { MeshFrameData frame; };
layout(scalar, binding = 1) readonly buffer Rings { TubeRingData rings[]; };
#include "shaders/lib/mesh_vertex.glsl"
#include "shaders/lib/rings.glsl"

void main() {
  const TubeRingData ring = rings[gl_VertexIndex >> RING_SHIFT];
  const uint side = uint(gl_VertexIndex) & ((1u << RING_SHIFT) - 1u);
  const vec3 tangent = unpack_direction(ring.tangent);
  const vec3 ring_normal = unpack_direction(ring.normal), first = normalize(ring_normal - dot(ring_normal, tangent) * tangent);
  const float angle = 6.28318530717958647692 * float(side) / float(gl_InstanceIndex);  // the instance index is the number of sides
  const vec3 outward = cos(angle) * first + sin(angle) * cross(tangent, first);
  emit_vertex(ring.center + ring.radius * outward, sqrt(max(0.0, 1.0 - ring.normal_tilt * ring.normal_tilt)) * outward + ring.normal_tilt * tangent,
               ring_color(ring.color), ring.id);
  // clips the walls to a gap ring
  if ((ring.color & RING_GAP) != 0u) gl_ClipDistance[0] = -1.0e30;
}
