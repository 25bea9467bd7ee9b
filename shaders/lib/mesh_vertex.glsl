// A vertex of lit triangles, placed: all outputs of the vertex stage. The uniform `frame` (MeshFrameData) is there.
layout(location = 0) out vec3 out_normal;   // view axes: x right, y up, z forward
layout(location = 1) out vec3 out_color;
layout(location = 2) out vec3 out_view;     // position in the view
layout(location = 3) out float out_depth;
layout(location = 4) flat out uint out_id;
layout(location = 5) out vec3 out_edges;    // distances from the triangle's edges, 1 at the opposite corner; 1 where they are not drawn
out float gl_ClipDistance[MAX_CLIPS];

void place_vertex(vec3 position, vec3 normal, vec3 color, uint id) {
  const vec3 turned = frame.view_from_world * position;
  const vec3 view = turned + frame.offset;
  out_normal = frame.view_from_world * normal;
  out_color = color;
  out_view = view;
  out_depth = turned.z + frame.offset_depth;
  out_id = id & ID_MASK;
  const uint corner = id >> CORNER_SHIFT & 3u;
  out_edges = corner == 0u ? vec3(1.0) : vec3(corner == 1u, corner == 2u, corner == 3u);
  const bool clipped = (id & UNCLIPPED) == 0u;
  // planes beyond clip_count are zero: they keep everything. No branch on uniforms: a CPU driver builds such a shader at every draw
  const float counts = clipped ? 1.0 : 0.0;
  for (int i = 0; i < MAX_CLIPS; ++i) gl_ClipDistance[i] = counts * (dot(frame.clips[i].xyz, position) + frame.clips[i].w) + (1.0 - counts);
  const float flat_view = float(frame.orthographic);
  const vec2 clip = vec2(view.x * frame.scale.x, -view.y * frame.scale.y) + frame.shift * mix(view.z, 1.0, flat_view);
  const float depth = (frame.depth_far - view.z) / (frame.depth_far - frame.depth_near);
  gl_Position = vec4(clip, mix(frame.depth_near, depth, flat_view), mix(view.z, 1.0, flat_view));
}
