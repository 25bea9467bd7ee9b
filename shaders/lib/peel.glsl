// SPDX-License-Identifier: MIT
// Depth peeling: selection of the fragments of a translucent layer (render/passes/passes.h). Depths are compared in the depth buffer's
// precision, and equal depths by id, so that this comparison and the depth test agree exactly.
layout(constant_id = 1) const uint MODE = MODE_OPAQUE;
layout(constant_id = 2) const uint HAS_OPAQUE = 0;
layout(scalar, binding = 5) uniform Layers { LayerData layer; };
layout(binding = 6) uniform texture2D opaque_depth;
layout(binding = 7) uniform texture2D previous_depth;  // depth of the previous layer
layout(binding = 8) uniform utexture2D previous_id;
layout(location = 0) out vec4 out_color;
layout(location = 1) out float out_depth;
layout(location = 2) out uint out_id;

float layer_depth(float t) {
  const float z = t + layer.reference_depth;
  if (layer.orthographic != 0u) return clamp((layer.depth_far - z) / (layer.depth_far - layer.depth_near), 0.0, 1.0);
  return clamp(layer.depth_near / max(z, 1e-30), 0.0, 1.0);
}

bool in_layer(float t, uint id) {
  const ivec2 at = ivec2(gl_FragCoord.xy);
  if (HAS_OPAQUE != 0u && t >= texelFetch(opaque_depth, at, 0).r) return false;
  if (MODE == MODE_FIRST) return true;
  const float here = layer_depth(t), passed = layer_depth(texelFetch(previous_depth, at, 0).r);
  return here < passed || (here == passed && id > texelFetch(previous_id, at, 0).r);
}

// Writes a fragment, or nothing: a depth of 0 never passes the depth test (cheaper and safer than discard). `color` is premultiplied by
// alpha.
void write_fragment(bool is_visible, vec3 color, float alpha, float t, uint id) {
  if (MODE != MODE_OPAQUE && is_visible) is_visible = in_layer(t, id);
  out_color = vec4(color, alpha);
  out_depth = t;
  out_id = id;
  gl_FragDepth = is_visible ? layer_depth(t) : 0.0;
  if (MODE == MODE_TAIL) {
    // weighted by optical depth: rgb is summed, alpha becomes the product of (1 - alpha)
    const float a = is_visible ? min(alpha, 0.999) : 0.0;
    out_color = vec4(a > 0.0 ? color / alpha * -log(1.0 - a) : vec3(0.0), a);
    if (!is_visible || !(a > 0.0)) out_depth = NO_DEPTH;
  }
}
