// SPDX-License-Identifier: MIT
// One packed volume along a ray: segments between samples s0, s1 with slopes d0, d1 along the ray; the value at the middle by the
// Hermite cubic, (s0 + s1) / 2 + (d0 - d1) L / 8; each half from the pre-integrated table (render/raycast/transfer_tables.h). A segment
// within a cube of plain bricks (render/residency/brick_map.h) is as long as the ray's way through it.
layout(constant_id = 0) const uint SHADED = 0;  // 1: by the gradient of the cell, 2: by gradients made beforehand
layout(constant_id = 1) const uint SKIPS_EMPTY = 0;
layout(constant_id = 2) const uint HAS_OPAQUE = 0;
layout(constant_id = 7) const uint HALF_OPACITY_DEPTH = 0;  // instead of a colour: the depth at which half of the light is gone

layout(binding = 4) uniform utexture2D preintegrated;  // 256 x 256
layout(binding = 8) uniform sampler3D gradients;       // render/residency/gradient_volume.h
#include "shaders/lib/packed.glsl"

#define SMALL_BRICK_SIZE 4.0
#define SEARCH_VOXELS 1.5  // the longest step to what is seen first
// Where it begins to be seen, segments are a part of a step, and grow; light wants shorter ones than colour. Where nothing is lit and
// nothing is empty they begin with the volume, and are whole.
const bool FROM_VISIBLE = SHADED != 0u || SKIPS_EMPTY != 0u;
const float FIRST_STEP = SHADED != 0u ? 0.125 : FROM_VISIBLE ? 0.25 : 1.0, STEP_GROWTH = SHADED != 0u ? 1.1 : 1.3;

// x: sigma, yzw: colour
vec4 lookup_preintegrated(float a, float b) {
  const uvec2 e = texelFetch(preintegrated, ivec2(int(a + 0.5), int(b + 0.5)), 0).rg;
  return vec4(uintBitsToFloat(e.x), vec3(e.y & 2047u, e.y >> 11 & 2047u, e.y >> 22) * vec3(1.0 / 2047.0, 1.0 / 2047.0, 1.0 / 1023.0));
}

// As `lit` (lighting.glsl) for a headlight, by the cosine between normal and ray: colour * x + y.
vec2 light_at(float n, float n2) {
  const float m = max(0.0, 2.0 * n2 - 1.0);
  const float m2 = m * m, m4 = m2 * m2, m8 = m4 * m4;
  return vec2(0.2 + 0.7 * n, 0.2 * m8 * m8 * m4);
}

// A sample of the ray at depth t, and what leads on from it.
struct RaySample {
  float t;
  vec3 p;
  PackedSample s;
  float slope;  // codes a depth, along the ray
};

// The gradient at a sample, codes a world length.
vec3 normal_at(RaySample at) {
  if (SHADED != 2u) return frame.grids[0].world_gradient * at.s.gradient;
  vec3 place = (at.p + 0.5) / (frame.grids[0].hi + 1.0);
  if (IS_BRICKED != 0u) {
    const vec3 brick = floor(clamp(floor(at.p), frame.grids[0].lo, frame.grids[0].hi - 1.0) * 0.125);
    const float nodes = ray_grid.gradient_nodes;
    place = (nodes * unpack_slot(at.s.brick) + 0.125 * (nodes - 1.0) * (at.p - 8.0 * brick) + 0.5) / vec3(textureSize(gradients, 0));
    if (!is_stored(at.s.brick)) return vec3(0.0);
  }
  return frame.grids[0].world_gradient * textureLod(gradients, place, 0.0).rgb;
}

// The mean light over half a segment along which the derivative goes from a to b, by the squared length of the gradient across the ray:
// the derivative is known far better than its direction is, and lights both sides alike.
vec2 light_between(float a, float b, float across2) {
  const float squares = (a * a + a * b + b * b) * (1.0 / 3.0), length2 = across2 + squares;
  const float sizes = a * b >= 0.0 ? 0.5 * abs(a + b) : 0.5 * (a * a + b * b) / abs(b - a);
  return length2 > 0.0 ? light_at(min(1.0, sizes * inversesqrt(length2)), squares / length2) : vec2(0.2, 0.0);
}

// What a march needs all along.
struct March {
  LocalRay ray;
  vec3 inverse, is_forward_axis;
  float h, end;  // of a segment, and where the last one ends
};

RaySample sample_at(March m, float t) {
  RaySample at;
  at.t = t;
  at.p = clamp(m.ray.origin + t * m.ray.direction, frame.grids[0].lo, frame.grids[0].hi);
  at.s = sample_packed(at.p);
  at.slope = dot(at.s.gradient, m.ray.direction);
  return at;
}

// The end of the segment that begins at `from`. `curved`: 0 where it leaps over plain bricks, whose values are as good as linear.
RaySample next_sample(March m, RaySample from, out float curved) {
  float next = from.t + m.h;
  curved = 1.0;
  if (SKIPS_EMPTY != 0u) {
    const float size = IS_BRICKED != 0u ? 8.0 : SMALL_BRICK_SIZE;
    const vec3 brick = min(floor(from.p * (1.0 / size)), ceil(frame.grids[0].hi * (1.0 / size)) - 1.0);
    const float d = float(IS_BRICKED != 0u ? from.s.brick >> 24 & 127u : texelFetch(homogeneous_map, ivec3(brick), 0).r);
    const vec3 way = (mix(brick + 1.0 - d, brick + d, m.is_forward_axis) * size - from.p) * m.inverse;
    const float leave = min(min(way.x, way.y), way.z);
    if (d > 0.0 && leave > m.h) {
      next = from.t + leave;
      curved = 0.0;
    }
  }
  if (next > m.end - 1e-3 * m.h) next = m.end;
  return sample_at(m, next);
}

// Which halves of the segment between two samples are seen at all: that of a sample in an invalid cell is not, nor is what was leapt over
// on the way to one or from one.
bvec2 visible_halves(RaySample a, RaySample b, float curved) {
  const bool both = a.s.valid && b.s.valid;
  return MASKED == 0u ? bvec2(true) : bvec2(both || (curved != 0.0 && a.s.valid), both || (curved != 0.0 && b.s.valid));
}

// The code half way; of a segment with one end in an invalid cell that of the other end.
float middle_code(RaySample a, RaySample b, float curved) {
  if (MASKED != 0u && a.s.valid != b.s.valid) return a.s.valid ? a.s.code : b.s.code;
  return clamp(0.5 * (a.s.code + b.s.code) + curved * 0.125 * (b.t - a.t) * (a.slope - b.slope), 0.0, 255.0);
}

// From s to where the ray begins to see, wherever the volume does: no rings, and none that move with the camera. Without light, and by steps
// that leap over no wall.
RaySample find_first_visible(March m, RaySample s) {
  m.h = min(m.h, SEARCH_VOXELS / length(m.ray.direction));
  float behind = 0.0, code_behind = 0.0, middle = 0.0;  // the end of the segment in which it is, and the codes there and half way
  for (bool seen = false; s.t < m.end && !seen;) {
    float curved;
    const RaySample e = next_sample(m, s, curved);
    middle = middle_code(s, e, curved);
    const bvec2 halves = visible_halves(s, e, curved);
    seen = (halves.x && lookup_preintegrated(s.s.code, middle).x > 0.0) || (halves.y && lookup_preintegrated(middle, e.s.code).x > 0.0);
    behind = e.t;
    code_behind = e.s.code;
    if (!seen) s = e;
  }
  float dark = 0.0, lit = 1.0;
  for (int k = 0; k < 3; ++k) {
    const float f = 0.5 * (dark + lit);
    const float code = mix(mix(s.s.code, middle, f), mix(middle, code_behind, f), f);
    bool in_front = lookup_preintegrated(s.s.code, code).x > 0.0;
    if (MASKED != 0u && !s.s.valid) in_front = sample_at(m, mix(s.t, behind, f)).s.valid;
    if (in_front) lit = f; else dark = f;
  }
  if (behind > s.t) s = sample_at(m, mix(s.t, behind, dark));
  return s;
}

// Where in a piece of one sigma half of the light is gone, as a share of its length; before > 0.5 >= after.
float half_transmittance_position(float before, float after) { return clamp(log(2.0 * before) / log(before / max(after, 1e-30)), 0.0, 1.0); }

// The premultiplied colour of the ray of pixel place q, up to depth `end`; with HALF_OPACITY_DEPTH that depth, and alpha 1 where there is one.
vec4 march_packed(vec2 q, float end) {
  const vec3 world = world_direction(q);
  const float world_per_depth = length(world);
  March m;
  m.ray = local_ray(0, q);
  vec2 interval = visible_interval(0, m.ray, q);
  m.end = min(interval.y, end);
  if (!(interval.x < m.end)) return HALF_OPACITY_DEPTH != 0u ? vec4(NO_DEPTH, 0.0, 0.0, 0.0) : vec4(0.0);
  m.h = frame.step_world / world_per_depth;
  m.inverse = safe_inverse(m.ray.direction);
  m.is_forward_axis = mix(vec3(0.0), vec3(1.0), is_forward(m.ray.direction));
  const vec3 along_ray = world / world_per_depth;
  float transmittance = 1.0;
  vec3 sum = vec3(0.0);
  RaySample s = sample_at(m, interval.x);
  if (FROM_VISIBLE) s = find_first_visible(m, s);
  // shading: the gradient, its share along the ray and the square of the rest
  vec3 normal = vec3(0.0);
  float along = 0.0, across2 = 0.0;
  if (SHADED != 0u) {
    normal = normal_at(s);
    along = dot(normal, along_ray);
    across2 = dot(normal, normal) - along * along;
  }
  vec3 last = vec3(0.0);
  const float begin = s.t, longest = m.h, voxels = length(m.ray.direction);
  m.h *= FIRST_STEP;
  while (s.t < m.end && transmittance > frame.termination) {
    float curved;
    const RaySample e = next_sample(m, s, curved);
    m.h = min(longest, STEP_GROWTH * m.h);
    const float extent = e.t - s.t;

    // its two halves
    const float middle = middle_code(s, e, curved);
    vec4 first = lookup_preintegrated(s.s.code, middle), second = lookup_preintegrated(middle, e.s.code);
    if (MASKED != 0u) {
      const bvec2 halves = visible_halves(s, e, curved);
      if (!halves.x) first.x = 0.0;
      if (!halves.y) second.x = 0.0;
    }
    const float half_length = -0.5 * 1.44269504 * extent * world_per_depth;
    const float half_way = transmittance * exp2(first.x * half_length);
    const float after = half_way * exp2(second.x * half_length);
    if (HALF_OPACITY_DEPTH != 0u && after <= 0.5) {
      const float part = half_way <= 0.5 ? half_transmittance_position(transmittance, half_way) : 1.0 + half_transmittance_position(half_way, after);
      return vec4(s.t + 0.5 * extent * part, 0.0, 0.0, 1.0);
    }
    if (SHADED != 0u) {
      vec3 normal_end = normal_at(e);
      if (MASKED != 0u && !e.s.valid) normal_end = normal;
      const float along_end = dot(normal_end, along_ray), across2_end = dot(normal_end, normal_end) - along_end * along_end;
      if (MASKED != 0u && !s.s.valid) {
        normal = normal_end;
        along = along_end;
        across2 = across2_end;
      }
      const float both = dot(normal, normal_end) - along * along_end, ends = along + along_end;
      float rise = (e.s.code - s.s.code) / (extent * world_per_depth);
      if (MASKED != 0u && s.s.valid != e.s.valid) rise = 0.5 * ends;
      // central differences reach as far as a segment of two voxels: the rise over longer ones knows their slope better, over shorter
      // ones it has the kinks of the cells
      const float by_rise = clamp(0.5 * (extent * voxels - 1.0), 0.0, 1.0);
      const float along_middle = SHADED == 1u ? 1.5 * rise - 0.25 * ends : mix(0.5 * ends, 0.75 * rise + 0.125 * ends, by_rise);
      const vec2 l0 = light_between(along, along_middle, max(0.0, 0.5625 * across2 + 0.375 * both + 0.0625 * across2_end));
      const vec2 l1 = light_between(along_middle, along_end, max(0.0, 0.0625 * across2 + 0.375 * both + 0.5625 * across2_end));
      normal = normal_end;
      along = along_end;
      across2 = across2_end;
      sum += (transmittance - half_way) * (first.yzw * l0.x + l0.y) + (half_way - after) * (second.yzw * l1.x + l1.y);
      last = second.yzw * l1.x + l1.y;
    } else {
      sum += (transmittance - half_way) * first.yzw + (half_way - after) * second.yzw;
      last = second.yzw;
    }
    transmittance = after;
    s = e;
  }
  if (HALF_OPACITY_DEPTH != 0u) return vec4(NO_DEPTH, 0.0, 0.0, 0.0);
  // what a ray that has ended early leaves out is taken for as dense as what it has met, and of a colour between the mean and the last
  if (s.t < m.end) {
    const float after = transmittance * exp2(log2(max(transmittance, 1e-30)) * (m.end - s.t) / (s.t - begin));
    sum += 0.5 * (transmittance - after) * (last + sum / (1.0 - transmittance));
    transmittance = after;
  }
  return vec4(sum, 1.0 - transmittance);
}
