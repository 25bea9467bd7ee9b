// SPDX-License-Identifier: MIT
// Blends the overlay (premultiplied) over the image (straight alpha) in place; the includer declares `image` with its format.
//   a = o.a + (1 - o.a) p.a,  rgb = (o.rgb + (1 - o.a) p.a p.rgb) / a
layout(local_size_x = 16, local_size_y = 4) in;
layout(binding = 0) uniform texture2D overlay;

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, imageSize(image)))) return;
  const vec4 over = texelFetch(overlay, at, 0);
  if (over.a == 0.0) return;
  const vec4 under = imageLoad(image, at);
  const float under_weight = (1.0 - over.a) * under.a, alpha = over.a + under_weight;
  imageStore(image, at, vec4((over.rgb + under_weight * under.rgb) / alpha, alpha));
}
