// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// Cursor that shines through occluders: shaded, faint where it faces the camera, with an outline at its silhouette. Premultiplied; alpha is
// negative where the cursor is the nearest opaque object (kOccludedOverlayFormat in render/passes/pass.h).
#include "shaders/shared/frame.h"

layout(scalar, binding = 0) uniform Frame { MeshFrameData frame; };
layout(binding = 1) uniform utexture2D opaque_id;
#include "shaders/lib/lighting.glsl"
#include "shaders/lib/mesh_color.glsl"
layout(location = 0) out vec4 out_color;

#define FACE_ALPHA 0.45
#define RIM_ALPHA 0.9
#define RIM_WHITE 0.75   // share of white in the bright ring
#define EDGE_SHARE 0.2   // share of the own color in the dark ring
#define EDGE_PIXELS 1.2  // width of the dark ring; RIM_PIXELS: of both rings
#define RIM_PIXELS 2.7

// Returns the distance to the silhouette in pixels. On a sphere or cylinder of radius r, n.v is proportional to sqrt(1 - (d / r)^2) at
// distance d from its middle, so that n.v / |gradient of n.v| = (r^2 - d^2) / d, about 2 (r - d) near the silhouette, for any orientation
// of the cylinder.
float pixels_inside() {
  const float facing = abs(dot(in_normal, to_camera()));
  return 0.5 * facing / max(length(vec2(dFdx(facing), dFdy(facing))), 1e-6);
}

void main() {
  const float inside = pixels_inside();
  const float rim = 1.0 - smoothstep(RIM_PIXELS - 0.5, RIM_PIXELS + 0.5, inside);
  const float edge = 1.0 - smoothstep(EDGE_PIXELS - 0.5, EDGE_PIXELS + 0.5, inside);
  const float alpha = mix(FACE_ALPHA, RIM_ALPHA, rim);
  const vec3 base = displayed_color(mesh_color());
  const vec3 color = mix(mix(base, vec3(1.0), RIM_WHITE * rim), EDGE_SHARE * base, edge);
  const bool hidden = texelFetch(opaque_id, ivec2(gl_FragCoord.xy), 0).r != in_id;
  out_color = vec4(alpha * color, hidden ? alpha : -alpha);
}
