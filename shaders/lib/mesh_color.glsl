// SPDX-License-Identifier: MIT
// Color of a triangle fragment: shaded, with edges as dark lines about one pixel wide.
layout(location = 0) in vec3 in_normal;
layout(location = 1) in vec3 in_color;
layout(location = 2) in vec3 in_view;
layout(location = 3) in float in_depth;
layout(location = 4) flat in uint in_id;
layout(location = 5) in vec3 in_edges;

#define EDGE_HALF_WIDTH 0.5   // pixels
#define EDGE_DARKNESS 0.25    // share of the triangle's color

vec3 to_camera() {
  return mix(-in_view / max(length(in_view), 1e-30), vec3(0.0, 0.0, -1.0), float(frame.orthographic));
}

vec3 mesh_color() {
  const vec3 a_pixel = vec3(length(vec2(dFdx(in_edges.x), dFdy(in_edges.x))), length(vec2(dFdx(in_edges.y), dFdy(in_edges.y))),
                            length(vec2(dFdx(in_edges.z), dFdy(in_edges.z))));
  const vec3 pixels = in_edges / max(a_pixel, vec3(1e-30));
  const float line = clamp(EDGE_HALF_WIDTH + 0.5 - min(min(pixels.x, pixels.y), pixels.z), 0.0, 1.0);
  const vec3 color = vertex_color(in_color);
  return fogged(mix(lit(color, in_normal, to_camera()), EDGE_DARKNESS * color, line), in_depth);
}
