// SPDX-License-Identifier: MIT
// One level of the fast raycast: a ray grid. Without a coarser level every texel is marched. With one, its rays are copied, and the texels
// between them are interpolated by the four-point cubic (-1, 9, 9, -1) / 16 along each axis, except in the 4 x 4 blocks marked by
// volume_blocks.frag: those are marched.
#include "shaders/shared/frame.h"
#include "shaders/shared/fast_volume.h"
layout(constant_id = 3) const uint REFINES = 0;  // there is a coarser level
layout(constant_id = 4) const uint MARCHES = 1;  // blocks may be marked

layout(scalar, binding = 0) uniform Frame { FrameData frame; };
layout(scalar, binding = 1) uniform RayGrid { RayGridData ray_grid; };
layout(binding = 2) uniform texture2D opaque_depth;
layout(binding = 6) uniform texture2D coarser;
layout(binding = 7) uniform utexture2D blocks;
layout(location = 0) out vec4 out_color;  // premultiplied

#define BRICK_SIZE 8
#include "shaders/lib/rays.glsl"
#ifdef HAS_CHANNELS
#include "shaders/lib/channels_march.glsl"
#else
#include "shaders/lib/fast_march.glsl"
#endif

vec4 coarser_texel(ivec2 at) { return texelFetch(coarser, at, 0); }
vec4 cubic_weights_at(int point) { return (point & 1) == 0 ? vec4(0.0, 1.0, 0.0, 0.0) : vec4(-0.0625, 0.5625, 0.5625, -0.0625); }

vec4 interpolate_row(ivec2 first, vec4 w) {
  return w.x * coarser_texel(first) + w.y * coarser_texel(first + ivec2(1, 0)) + w.z * coarser_texel(first + ivec2(2, 0)) +
         w.w * coarser_texel(first + ivec2(3, 0));
}

vec4 interpolated(ivec2 point) {
  const ivec2 first = (point >> 1) + (COARSE_APRON - 1);
  const vec4 wx = cubic_weights_at(point.x), wy = cubic_weights_at(point.y);
  vec4 c = wy.x * interpolate_row(first, wx) + wy.y * interpolate_row(first + ivec2(0, 1), wx) + wy.z * interpolate_row(first + ivec2(0, 2), wx) +
           wy.w * interpolate_row(first + ivec2(0, 3), wx);
  c.a = clamp(c.a, 0.0, 1.0);
  return max(c, vec4(0.0));
}

void main() {
  const ivec2 at = ivec2(gl_FragCoord.xy);
  const ivec2 point = at - int(ray_grid.apron);
  const vec2 pixel = vec2(point) * ray_grid.spacing + 0.5;
  float end = NO_DEPTH;
  if (HAS_OPAQUE != 0u) end = texelFetch(opaque_depth, clamp(ivec2(pixel), ivec2(0), ivec2(2.0 * frame.half_size) - 1), 0).r;
  if (REFINES == 0u) {
    out_color = march_packed(pixel - frame.axis, end);
  } else {
    const bool marked = MARCHES != 0u && texelFetch(blocks, at >> 2, 0).r != 0u && ((point.x | point.y) & 1) != 0;
    vec4 c = interpolated(point);
    if (MARCHES != 0u) {
      if (!marked) end = -NO_DEPTH;
      const vec4 marched = march_packed(pixel - frame.axis, end);
      if (marked) c = marched;
    }
    out_color = c;
  }
}
