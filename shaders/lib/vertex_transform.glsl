// SPDX-License-Identifier: MIT
// Position of a triangle vertex in the image, and its distances from the clip planes. The includer declares the uniform `frame`
// (MeshFrameData).
out float gl_ClipDistance[MAX_CLIP_PLANES];

// Returns the position in view axes (x right, y up, z forward), without `frame.offset`. The clip planes keep a vertex if they keep `middle`
// + `wall` or `middle` - `wall`; `inside` < 0: they remove the point at +`wall`.
vec3 transform_vertex(vec3 position, vec3 middle, vec3 wall, uint id, out float inside) {
  const vec3 turned = frame.view_from_world * position;
  const vec3 view = turned + frame.offset;
  const bool clipped = (id & UNCLIPPED) == 0u;
  // planes beyond clip_count are zero and keep everything. No branch on uniforms: a CPU driver rebuilds such a shader at every draw
  const float counts = clipped ? 1.0 : 0.0;
  inside = 1.0e30;
  for (int i = 0; i < MAX_CLIP_PLANES; ++i) {
    const vec4 plane = frame.clips[i];
    const float center = dot(plane.xyz, middle) + plane.w, reach = dot(plane.xyz, wall);
    gl_ClipDistance[i] = counts * (center + abs(reach)) + (1.0 - counts);
    inside = min(inside, counts * (center + reach));
  }
  const float flat_view = float(frame.orthographic);
  const vec2 clip = vec2(view.x * frame.scale.x, -view.y * frame.scale.y) + frame.shift * mix(view.z, 1.0, flat_view);
  const float depth = (frame.depth_far - view.z) / (frame.depth_far - frame.depth_near);
  gl_Position = vec4(clip, mix(frame.depth_near, depth, flat_view), mix(view.z, 1.0, flat_view));
  return turned;
}
