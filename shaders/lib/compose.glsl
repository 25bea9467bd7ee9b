// SPDX-License-Identifier: MIT
// Blends occluded_overlay over volume over opaque over background, premultiplied floats; writes straight alpha. Linear radiance is
// converted to the display encoding before the overlay. With SMOOTH_EDGES the contours of opaque items are antialiased. With HAND_SHADOW the
// haptic cursors cast shadows.
layout(constant_id = 0) const uint HAS_OPAQUE = 0;
layout(constant_id = 1) const uint HAS_VOLUME = 0;
layout(constant_id = 2) const uint HAS_OCCLUDED_OVERLAY = 0;
layout(constant_id = 3) const uint SMOOTH_EDGES = 0;
layout(scalar, binding = 0) uniform Compose { ComposeData compose; };
layout(binding = 1) uniform texture2D opaque_color;
layout(binding = 2) uniform texture2D volume_color;
layout(binding = 3) uniform texture2D occluded_overlay_color;
layout(binding = 4) uniform texture2D opaque_depth;
layout(binding = 5) uniform utexture2D opaque_id;
layout(location = 0) out vec4 out_color;
#ifdef HAND_SHADOW
#include "shaders/lib/hand_shadow.glsl"
#else
#include "shaders/lib/linear_color.glsl"
vec3 hand_on_opaque(ivec2 at) { return vec3(1.0); }
vec3 hand_on_volume(ivec2 at) { return vec3(1.0); }
#endif
#include "shaders/lib/smooth_edges.glsl"

void main() {
  const ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 sum = vec4(compose.background.rgb * compose.background.a, compose.background.a);
  if (HAS_OPAQUE != 0u) {
    vec4 c;
    if (SMOOTH_EDGES != 0u) c = smoothed_opaque(at);
    else c = texelFetch(opaque_color, at, 0);
    c.rgb *= hand_on_opaque(at);
    sum = c + (1.0 - c.a) * sum;
  }
  float volume_alpha = 0.0;
  if (HAS_VOLUME != 0u) {
    vec4 c = texelFetch(volume_color, at, 0);
    c.rgb *= hand_on_volume(at);
    sum = c + (1.0 - c.a) * sum;
    volume_alpha = c.a;
  }
  sum = premultiplied_to_display(sum, compose.is_linear, gl_FragCoord.xy);
  if (HAS_OCCLUDED_OVERLAY != 0u) {
    // opacity of the occluder: 1 behind an opaque item, else (negative alpha) the volume's alpha
    const vec4 c = texelFetch(occluded_overlay_color, at, 0);
    const vec4 occluded_overlay = (c.a < 0.0 ? volume_alpha : 1.0) * vec4(c.rgb, abs(c.a));
    sum = occluded_overlay + (1.0 - occluded_overlay.a) * sum;
  }
  out_color = sum.a > 0.0 ? vec4(sum.rgb / sum.a, sum.a) : vec4(0.0);
}
