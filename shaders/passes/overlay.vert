// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// Six vertices per shape, enlarged by a pixel for its antialiased edge; shapes of a hidden label are degenerate.
#include "shaders/shared/overlay.h"
#include "shaders/shared/frame.h"

layout(scalar, binding = 0) uniform Data { OverlayData data; };
layout(scalar, binding = 1) readonly buffer Shapes { OverlayShape shapes[]; };
layout(binding = 4) uniform texture2D opaque_depth;
layout(location = 0) out vec2 out_local;
layout(location = 1) flat out uint out_shape;

void main() {
  const uint corner = gl_VertexIndex % 6;
  out_shape = gl_VertexIndex / 6;
  const vec2 side = vec2(corner == 1 || corner == 3 || corner == 4 ? 1.0 : 0.0, corner == 2 || corner == 4 || corner == 5 ? 1.0 : 0.0);
  const vec2 lo = shapes[out_shape].lo, hi = shapes[out_shape].hi;
  const float soft = shapes[out_shape].kind == OVERLAY_GLYPH ? 0.0 : 1.0;
  out_local = mix(lo - soft, hi + soft, side);
  const vec2 position = shapes[out_shape].origin + out_local.x * shapes[out_shape].axis_x + out_local.y * shapes[out_shape].axis_y;
  gl_Position = vec4(position / data.half_size - 1.0, 0.0, 1.0);
  const uint has_depth = data.has_depth + uint(out_local.x < -1e30);  // as in as_nonuniform (rays.glsl)
  if (has_depth != 0u && shapes[out_shape].occlusion_depth < NO_DEPTH) {
    const ivec2 at = ivec2(floor(shapes[out_shape].anchor));
    const ivec2 size = textureSize(opaque_depth, 0);
    if (all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, size)) &&
        texelFetch(opaque_depth, at, 0).r < shapes[out_shape].occlusion_depth - data.depth_slack)
      gl_Position = vec4(2.0, 2.0, 0.0, 1.0);
  }
}
