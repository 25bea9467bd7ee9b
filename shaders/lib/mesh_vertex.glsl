// SPDX-License-Identifier: MIT
// Outputs of the vertex stage for a vertex of shaded triangles. The includer declares the uniform `frame` (MeshFrameData).
layout(location = 0) out vec3 out_normal;   // view axes: x right, y up, z forward
layout(location = 1) out vec3 out_color;
layout(location = 2) out vec3 out_view;     // position in view axes
layout(location = 3) out float out_depth;
layout(location = 4) flat out uint out_id;
layout(location = 5) out vec3 out_edges;    // distances from the triangle's edges, 1 at the opposite corner; 1 for hidden edges
#include "shaders/lib/vertex_transform.glsl"

void emit_vertex(vec3 position, vec3 normal, vec3 color, uint id) {
  float inside;
  const vec3 turned = transform_vertex(position, position, vec3(0.0), id, inside);
  out_normal = frame.view_from_world * normal;
  out_color = color;
  out_view = turned + frame.offset;
  out_depth = turned.z + frame.offset_depth;
  out_id = id & ID_MASK;
  const uint corner = id >> CORNER_SHIFT & 3u;
  out_edges = corner == 0u ? vec3(1.0) : vec3(corner == 1u, corner == 2u, corner == 3u);
}
