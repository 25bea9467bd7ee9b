// SPDX-License-Identifier: MIT
// Ray march through one packed volume, in segments between samples s0, s1 with slopes d0, d1 along the ray. The value at the middle is that
// of the Hermite cubic, (s0 + s1) / 2 + (d0 - d1) L / 8; each half is integrated by the pre-integrated table
// (render/raycast/transfer_tables.h). A segment in a cube of homogeneous bricks (render/residency/brick_map.h) extends to the ray's exit
// from the cube.
#include "shaders/lib/preintegrated.glsl"
#ifdef IS_PAGED
#include "shaders/lib/paged.glsl"
#else
#include "shaders/lib/packed.glsl"
#endif

#define SEARCH_VOXELS 1.5  // maximum step of the search for the first visible value
// At the first visible value, segments are a part of a step, and grow; shading needs shorter ones than color. Unshaded rays without
// empty-space skipping start at the volume's boundary with full steps.
const bool FROM_VISIBLE = SHADED != 0u || SKIPS_EMPTY != 0u;
const float FIRST_STEP = SHADED != 0u ? 0.125 : FROM_VISIBLE ? 0.25 : 1.0, STEP_GROWTH = SHADED != 0u ? 1.1 : 1.3;

// Sample of the ray at depth t, with the slope for the segment after it.
struct RaySample {
  float t;
  vec3 p;
  PackedSample s;
  float slope;  // codes per unit of depth, along the ray
};

// Returns the gradient at a sample, in codes per world unit.
vec3 normal_at(RaySample at) {
  return frame.grids[0].world_gradient * (SHADED == 2u ? smooth_gradient(at.p, at.s) : at.s.gradient);
}

// Returns the light of the scene on a gradient.
Lighting reflected_light(vec3 gradient, vec3 to_camera) {
  const Lighting light = lighting_of(gradient, to_camera);
  if (HAS_LIGHTS != 2u) return light;
  return with_phase(light, frame.grids[0].surface_share, frame.grids[0].anisotropy, to_camera);
}

// Returns the mean light of a headlight over half a segment, along which the derivative goes from a to b. `across2`: squared length of the gradient's
// component across the ray. The derivative is known better than the gradient's direction; both sides are shaded alike.
Lighting headlight_between(float a, float b, float across2, vec3 to_camera) {
  const float squares = (a * a + a * b + b * b) * (1.0 / 3.0), length2 = across2 + squares;
  const float sizes = a * b >= 0.0 ? 0.5 * abs(a + b) : 0.5 * (a * a + b * b) / abs(b - a);
  return length2 > 0.0 ? headlight_at(min(1.0, sizes * inversesqrt(length2)), squares / length2) : without_normal(to_camera);
}

// Constant data of a march.
struct March {
  LocalRay ray;
  vec3 inverse, is_forward_axis;
  float h, end;  // length of a segment, and end of the last one
};

RaySample sample_at(March m, float t) {
  RaySample at;
  at.t = t;
  at.p = clamp(m.ray.origin + t * m.ray.direction, frame.grids[0].lo, frame.grids[0].hi);
  at.s = sample_packed(at.p);
  at.slope = dot(at.s.gradient, m.ray.direction);
  return at;
}

// Returns the sample at the end of the segment that begins at `from`. `curved`: 0 if the segment skips homogeneous bricks, where values are
// linear for the table.
RaySample next_sample(March m, RaySample from, out float curved) {
  const float h = m.h * voxel_width(from.s);
  float next = from.t + h;
  curved = 1.0;
  if (SKIPS_EMPTY != 0u) {
    const float leave = homogeneous_exit(from.s, from.p, m.inverse, m.is_forward_axis);
    // light varies in homogeneous regions, unless nothing is seen there
    if (leave > h && (HAS_LIGHTS != 2u || lookup_preintegrated(from.s.code, from.s.code).x == 0.0)) {
      next = from.t + leave;
      curved = 0.0;
    }
  }
  if (next > m.end - 1e-3 * h) next = m.end;
  return sample_at(m, next);
}

// Returns which halves of the segment between two samples are visible. The half of a sample in an invalid cell is not; after a skip to or
// from an invalid cell, neither half is.
bvec2 visible_halves(RaySample a, RaySample b, float curved) {
  const bool both = a.s.valid && b.s.valid;
  return MASKED == 0u ? bvec2(true) : bvec2(both || (curved != 0.0 && a.s.valid), both || (curved != 0.0 && b.s.valid));
}

// Returns the code at the middle; if one end lies in an invalid cell, the code of the other end.
float middle_code(RaySample a, RaySample b, float curved) {
  if (MASKED != 0u && a.s.valid != b.s.valid) return a.s.valid ? a.s.code : b.s.code;
  return clamp(0.5 * (a.s.code + b.s.code) + curved * 0.125 * (b.t - a.t) * (a.slope - b.slope), 0.0, 255.0);
}

// Returns the sample where the ray begins to see, anywhere in the volume: avoids rings, in particular rings that move with the camera.
// Ignores shading, and uses steps that skip no thin wall.
RaySample find_first_visible(March m, RaySample s) {
  m.h = min(m.h, SEARCH_VOXELS / length(m.ray.direction));
  float behind = 0.0, code_behind = 0.0, middle = 0.0;  // end of the segment with the first visible value, its code, and the code at the segment's middle
  for (bool found = false; s.t < m.end && !found;) {
    float curved;
    const RaySample e = next_sample(m, s, curved);
    middle = middle_code(s, e, curved);
    const bvec2 halves = visible_halves(s, e, curved);
    found = (halves.x && lookup_preintegrated(s.s.code, middle).x > 0.0) || (halves.y && lookup_preintegrated(middle, e.s.code).x > 0.0);
    behind = e.t;
    code_behind = e.s.code;
    if (!found) s = e;
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

// Returns the premultiplied color along the ray of pixel coordinate q, up to depth `end`; with HALF_OPACITY_DEPTH that depth, and alpha 1
// if it exists.
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
  // shading: the gradient, its component along the ray, the squared length of the rest, and what lights of the scene add there
  vec3 normal = vec3(0.0);
  float along = 0.0, across2 = 0.0;
  Lighting light = without_normal(-along_ray);
  if (SHADED != 0u) {
    normal = normal_at(s);
    along = dot(normal, along_ray);
    across2 = dot(normal, normal) - along * along;
    if (HAS_LIGHTS != 0u) light = reflected_light(normal, -along_ray);
  }
  vec3 last = vec3(0.0);
  const float begin = s.t, longest = m.h, voxels = length(m.ray.direction);
  m.h *= FIRST_STEP;
  while (s.t < m.end && transmittance > frame.termination) {
    float curved;
    const RaySample e = next_sample(m, s, curved);
    m.h = min(longest, STEP_GROWTH * m.h);
    const float extent = e.t - s.t;

    // the two halves of the segment
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
      const float split = half_way <= 0.5 ? half_transmittance_position(transmittance, half_way) : 1.0 + half_transmittance_position(half_way, after);
      return vec4(s.t + 0.5 * extent * split, 0.0, 0.0, 1.0);
    }
    receive_between(q, s.t, e.t, first.x + second.x > 0.0);
    if (SHADED != 0u) {
      vec3 normal_end = normal_at(e);
      if (MASKED != 0u && !e.s.valid) normal_end = normal;
      const float along_end = dot(normal_end, along_ray), across2_end = dot(normal_end, normal_end) - along_end * along_end;
      if (MASKED != 0u && !s.s.valid) {
        normal = normal_end;
        along = along_end;
        across2 = across2_end;
      }
      const float both = dot(normal, normal_end) - along * along_end, end_sum = along + along_end;
      float rise = (e.s.code - s.s.code) / (extent * world_per_depth);
      if (MASKED != 0u && s.s.valid != e.s.valid) rise = 0.5 * end_sum;
      // central differences span two voxels: over a longer segment the difference of the codes gives the slope better, over a shorter one
      // it shows the kinks between cells
      const float by_rise = clamp(0.5 * (extent * voxels - 1.0), 0.0, 1.0);
      const float along_middle = SHADED == 1u ? 1.5 * rise - 0.25 * end_sum : mix(0.5 * end_sum, 0.75 * rise + 0.125 * end_sum, by_rise);
      Lighting l0, l1;
      if (HAS_LIGHTS != 0u) {
        const Lighting light_end = reflected_light(normal_end, -along_ray);
        if (MASKED != 0u && !s.s.valid) light = light_end;
        const Lighting light_middle = reflected_light(0.5 * (normal + normal_end) + (along_middle - 0.5 * end_sum) * along_ray, -along_ray);
        l0 = mean_light(light, light_middle);
        l1 = mean_light(light_middle, light_end);
        light = light_end;
      } else {
        l0 = headlight_between(along, along_middle, max(0.0, 0.5625 * across2 + 0.375 * both + 0.0625 * across2_end), -along_ray);
        l1 = headlight_between(along_middle, along_end, max(0.0, 0.0625 * across2 + 0.375 * both + 0.5625 * across2_end), -along_ray);
      }
      normal = normal_end;
      along = along_end;
      across2 = across2_end;
      last = lit(second.yzw, l1);
      sum += (transmittance - half_way) * lit(first.yzw, l0) + (half_way - after) * last;
    } else {
      if (HAS_LIGHTS == 2u) {
        const Lighting scattered = scattered_light(frame.grids[0].anisotropy, -along_ray);
        first.yzw = lit(first.yzw, scattered);
        second.yzw = lit(second.yzw, scattered);
      }
      sum += (transmittance - half_way) * first.yzw + (half_way - after) * second.yzw;
      last = second.yzw;
    }
    transmittance = after;
    seen_transmittance = transmittance;
    s = e;
  }
  if (HALF_OPACITY_DEPTH != 0u) return vec4(NO_DEPTH, 0.0, 0.0, 0.0);
  // the rest of a terminated ray: the mean optical density so far, and a color between the mean and the last one
  if (s.t < m.end) {
    const float after = transmittance * exp2(log2(max(transmittance, 1e-30)) * (m.end - s.t) / (s.t - begin));
    sum += 0.5 * (transmittance - after) * (last + sum / (1.0 - transmittance));
    transmittance = after;
  }
  return vec4(sum, 1.0 - transmittance);
}
