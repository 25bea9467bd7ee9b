// SPDX-License-Identifier: MIT
// Morphological antialiasing of the opaque image (A. Reshetov, HPG 2009): where the ids of two neighboring pixels differ, or their depths
// jump, the contour between them is a staircase. Each step is replaced by a straight line from the middle of one riser to the middle of the
// step, and the part of a pixel that this line cuts off takes the color of the neighbor. Pixels away from contours are unchanged.
// The includer declares `compose` (ComposeData), opaque_color, opaque_depth and opaque_id. The bounds of the loops come from a uniform:
// an unrolled shader takes longer to compile than most images to render.
#define DEPTH_JUMP 4.0       // ratio of a depth jump to the differences beside it
#define MIN_DEPTH_JUMP 1e-5  // share of the depth

float depth_at(ivec2 p) { return texelFetch(opaque_depth, clamp(p, ivec2(0), textureSize(opaque_depth, 0) - 1), 0).r; }

// Returns whether a contour separates a pixel and its neighbor in direction s.
bool is_contour(ivec2 p, ivec2 s) {
  const ivec2 q = p + s, size = textureSize(opaque_color, 0);
  if (any(lessThan(min(p, q), ivec2(0))) || any(greaterThanEqual(max(p, q), size))) return false;
  const uint id = texelFetch(opaque_id, p, 0).r, other = texelFetch(opaque_id, q, 0).r;
  if (id != other) return true;
  if (id == 0u) return false;  // the background
  const float near = depth_at(p), far = depth_at(q);
  const float jump = abs(far - near);
  if (jump <= MIN_DEPTH_JUMP * max(abs(near), abs(far))) return false;
  const float beside = max(abs(near - depth_at(p - s)), abs(depth_at(q + s) - far));
  return jump > DEPTH_JUMP * beside;
}

// Area of a pixel, n pixels from the riser, under the line from half a pixel at the riser to 0 in the middle of a step of that length.
float cut_area(int n, float half_length) {
  const float a = min(float(n), half_length), b = min(float(n + 1), half_length);
  return 0.5 * ((b - a) - 0.5 * (b * b - a * a) / half_length);
}

// Returns the share of pixel p that has the color of its neighbor in direction s, across a contour.
float neighbor_share(ivec2 p, ivec2 s) {
  // at both ends of the step: number of pixels to it, and whether the riser is on the side of p
  int lengths[2] = int[2](0, 0);
  bool turns_here[2] = bool[2](false, false);
  for (int end = 0; end < compose.ends; ++end) {
    const ivec2 along = (2 * end - 1) * s.yx;
    int n = 0;
    for (; n < compose.max_step; ++n) {
      const ivec2 last = p + n * along;
      const bool here = is_contour(last, along), there = is_contour(last + s, along);
      turns_here[end] = here && !there;
      if (here || there || !is_contour(last + along, s)) break;
    }
    lengths[end] = n;
  }
  const float half_length = 0.5 * float(lengths[0] + lengths[1] + 1);
  return (turns_here[0] ? cut_area(lengths[0], half_length) : 0.0) + (turns_here[1] ? cut_area(lengths[1], half_length) : 0.0);
}

// Returns false only if no contour passes beside the pixel: its neighbors have the same id, and opposite depths differ alike.
bool may_be_at_contour(ivec2 p) {
  const uint id = texelFetch(opaque_id, p, 0).r;
  const ivec2 last = textureSize(opaque_id, 0) - 1;
  bool may_be = false;
  ivec2 side = ivec2(1, 0);
  for (int i = 0; i < compose.ends; ++i) {
    const ivec2 a = max(p - side, ivec2(0)), b = min(p + side, last);
    const float here = depth_at(p), before = abs(depth_at(a) - here), after = abs(depth_at(b) - here);
    may_be = may_be || texelFetch(opaque_id, a, 0).r != id || texelFetch(opaque_id, b, 0).r != id;
    may_be = may_be || (id != 0u && max(before, after) > DEPTH_JUMP * min(before, after));
    side = side.yx;
  }
  return may_be;
}

vec4 smoothed_opaque(ivec2 p) {
  if (!may_be_at_contour(p)) return texelFetch(opaque_color, p, 0);
  int contours = 0;  // bits, by side
  ivec2 side = ivec2(1, 0);
  for (int i = 0; i < compose.sides; ++i) {
    if (is_contour(p, side)) contours |= 1 << i;
    side = ivec2(-side.y, side.x);
  }
  vec4 sum = vec4(0.0);
  float own = 1.0;
  for (int i = 0; i < compose.sides; ++i) {
    // an item that is one pixel wide keeps its color, or it would fade
    if ((contours >> i & 1) == 1 && (contours >> (i + 2 & 3) & 1) == 0) {
      const float share = neighbor_share(p, side);
      sum += share * texelFetch(opaque_color, p + side, 0);
      own -= share;
    }
    side = ivec2(-side.y, side.x);
  }
  return sum + own * texelFetch(opaque_color, p, 0);
}
