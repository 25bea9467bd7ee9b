// SPDX-License-Identifier: MIT
// Ray march through several channels of one paged volume at once. Segments as in fast_march.glsl, each with the sum of the channels'
// extinctions and their mean color by extinction. Homogeneous parts are invisible in all channels. Vectors have a component per channel.
#include "shaders/lib/preintegrated.glsl"
#include "shaders/lib/packed_cell.glsl"
#include "shaders/lib/page_table.glsl"
layout(constant_id = 8) const int CHANNEL_COUNT = 2;
layout(constant_id = 9) const uint SHADED_CHANNELS = 0;  // one bit per channel

struct ChannelSample {
  vec4 codes;
  mat3x4 gradients;  // codes per finest voxel along x, y, z
  bvec4 valid;       // false in homogeneous entries of the page table
  PagePlace place;
};

ChannelSample sample_channels(vec3 p) {
  ChannelSample s;
  s.place = find_place(p);
  s.codes = vec4(0.0);
  s.gradients = mat3x4(0.0);
  s.valid = bvec4(false);
  if (!is_stored(s.place.word)) return s;
  const vec3 base = cell_of(s.place.at), f = s.place.at - base, scale = s.place.scale;
  const ivec3 at = unpack_slot(s.place.word) * PAGE_TEXELS + ivec3(base);
  // texels of two codes, of a node and of its neighbor along x, at (y, z) = (0,0) (1,0) (0,1) (1,1)
  const uvec4 t00 = texelFetch(packed_words, at, 0), t10 = texelFetch(packed_words, at + ivec3(0, 1, 0), 0),
              t01 = texelFetch(packed_words, at + ivec3(0, 0, 1), 0), t11 = texelFetch(packed_words, at + ivec3(0, 1, 1), 0);
  const vec4 a00 = vec4(t00 & 255u), b00 = vec4(t00 >> 8), a10 = vec4(t10 & 255u), b10 = vec4(t10 >> 8);
  const vec4 a01 = vec4(t01 & 255u), b01 = vec4(t01 >> 8), a11 = vec4(t11 & 255u), b11 = vec4(t11 >> 8);
  s.valid = bvec4(true);
  if (MASKED != 0u) s.valid = notEqual(min(min(min(a00, b00), min(a10, b10)), min(min(a01, b01), min(a11, b11))), vec4(0.0));
  const vec4 x00 = b00 - a00, x10 = b10 - a10, x01 = b01 - a01, x11 = b11 - a11;
  const vec4 v00 = a00 + x00 * f.x, v10 = a10 + x10 * f.x, v01 = a01 + x01 * f.x, v11 = a11 + x11 * f.x;
  const vec4 v0 = mix(v00, v10, f.y), v1 = mix(v01, v11, f.y);
  s.codes = mix(v0, v1, f.z);
  s.gradients = mat3x4(scale.x * mix(mix(x00, x10, f.y), mix(x01, x11, f.y), f.z), scale.y * mix(v10 - v00, v11 - v01, f.z), scale.z * (v1 - v0));
  return s;
}

// Returns the central differences over a voxel of the page's level on either side, as smooth_gradient in paged.glsl.
mat3x4 smooth_gradients(vec3 p, ChannelSample s) {
  const float width = s.place.width;
  mat3x4 gradients;
  for (int axis = 0; axis < 3; ++axis) {
    vec3 step = vec3(0.0);
    step[axis] = width;
    const vec3 a = clamp(p - step, frame.grids[0].lo, frame.grids[0].hi), b = clamp(p + step, frame.grids[0].lo, frame.grids[0].hi);
    const ChannelSample low = sample_channels(a), high = sample_channels(b);
    const vec4 to_low = mix(vec4(0.0), vec4(dot(p - a, vec3(1.0))), low.valid), to_high = mix(vec4(0.0), vec4(dot(b - p, vec3(1.0))), high.valid);
    const vec4 change = mix(s.codes, high.codes, high.valid) - mix(s.codes, low.codes, low.valid);
    gradients[axis] = change / max(to_low + to_high, vec4(1e-6));
  }
  return gradients;
}

// Sample of the ray at depth t, with the channels' slopes along the ray.
struct RaySample {
  float t;
  vec3 p;
  ChannelSample s;
  vec4 slopes;  // codes per unit of depth
};

RaySample sample_at(LocalRay ray, float t) {
  RaySample at;
  at.t = t;
  at.p = clamp(ray.origin + t * ray.direction, frame.grids[0].lo, frame.grids[0].hi);
  at.s = sample_channels(at.p);
  at.slopes = at.s.gradients * ray.direction;
  return at;
}

// Returns the gradients for shading at the middle of a segment, where the codes are `middle`, up to a factor.
mat3x4 shading_gradients(RaySample a, RaySample b, vec4 middle) {
  if (SHADED != 2u) return a.s.gradients + b.s.gradients;
  ChannelSample s = a.s;
  s.codes = middle;
  return smooth_gradients(0.5 * (a.p + b.p), s);
}

// Returns the light on a channel by its gradient. `along_ray`: unit vector, world axes.
Lighting light_of_channel(int channel, mat3x4 gradients, vec3 along_ray) {
  if ((SHADED_CHANNELS >> channel & 1u) == 0u) {
    if (HAS_LIGHTS == 2u) return scattered_light(frame.grids[0].anisotropy, -along_ray);
    return Lighting(vec3(1.0), vec3(0.0));
  }
  const vec3 normal = frame.grids[0].world_gradient * vec3(gradients[0][channel], gradients[1][channel], gradients[2][channel]);
  if (HAS_LIGHTS != 0u) return lighting_of(normal, -along_ray);
  const float along = dot(normal, along_ray), length2 = dot(normal, normal);
  return length2 > 0.0 ? headlight_at(abs(along) * inversesqrt(length2), along * along / length2) : without_normal(-along_ray);
}

// Returns the premultiplied color along the ray of pixel coordinate q, up to depth `end`; with HALF_OPACITY_DEPTH that depth, and alpha 1
// if it exists.
vec4 march_packed(vec2 q, float end) {
  const vec3 world = world_direction(q);
  const float world_per_depth = length(world);
  const LocalRay ray = local_ray(0, q);
  const vec2 interval = visible_interval(0, ray, q);
  const float last = min(interval.y, end);
  if (!(interval.x < last)) return HALF_OPACITY_DEPTH != 0u ? vec4(NO_DEPTH, 0.0, 0.0, 0.0) : vec4(0.0);
  const vec3 inverse = safe_inverse(ray.direction), is_forward_axis = mix(vec3(0.0), vec3(1.0), is_forward(ray.direction));
  const vec3 along_ray = world / world_per_depth;
  const float h = frame.step_world / world_per_depth;
  float transmittance = 1.0;
  vec3 sum = vec3(0.0);
  RaySample s = sample_at(ray, interval.x);
  while (s.t < last && transmittance > frame.termination) {
    const float step = h * s.s.place.width;
    const float leave = SKIPS_EMPTY != 0u ? page_exit(s.s.place, s.p, inverse, is_forward_axis) : 0.0;
    const bool skips = leave > step;
    float next = s.t + (skips ? leave : step);
    if (next > last - 1e-3 * step) next = last;
    const RaySample e = sample_at(ray, next);
    if (!skips) {
      const float extent = e.t - s.t;
      vec4 middle = clamp(0.5 * (s.s.codes + e.s.codes) + 0.125 * extent * (s.slopes - e.slopes), 0.0, 255.0);
      middle = mix(mix(middle, s.s.codes, not(e.s.valid)), e.s.codes, not(s.s.valid));
      vec4 a[4], b[4];         // of each channel, in both halves
      vec2 sigma = vec2(0.0);  // of both halves
      for (int channel = 0; channel < CHANNEL_COUNT; ++channel) {
        a[channel] = lookup_preintegrated(channel, s.s.codes[channel], middle[channel]);
        b[channel] = lookup_preintegrated(channel, middle[channel], e.s.codes[channel]);
        if (!s.s.valid[channel]) a[channel].x = 0.0;
        if (!e.s.valid[channel]) b[channel].x = 0.0;
        sigma += vec2(a[channel].x, b[channel].x);
      }
      mat3x4 gradients = mat3x4(0.0);
      if (SHADED != 0u && sigma.x + sigma.y > 0.0) gradients = shading_gradients(s, e, middle);
      vec3 first = vec3(0.0), second = vec3(0.0);
      receive_between(q, s.t, e.t, sigma.x + sigma.y > 0.0);
      for (int channel = 0; channel < CHANNEL_COUNT; ++channel) {
        const Lighting light = light_of_channel(channel, gradients, along_ray);
        first += a[channel].x * lit(a[channel].yzw, light);
        second += b[channel].x * lit(b[channel].yzw, light);
      }
      const float half_length = -0.5 * 1.44269504 * extent * world_per_depth;
      const float half_way = transmittance * exp2(sigma.x * half_length), after = half_way * exp2(sigma.y * half_length);
      if (HALF_OPACITY_DEPTH != 0u && after <= 0.5) {
        const float split = half_way <= 0.5 ? half_transmittance_position(transmittance, half_way) : 1.0 + half_transmittance_position(half_way, after);
        return vec4(s.t + 0.5 * extent * split, 0.0, 0.0, 1.0);
      }
      if (sigma.x > 0.0) sum += (transmittance - half_way) / sigma.x * first;
      if (sigma.y > 0.0) sum += (half_way - after) / sigma.y * second;
      transmittance = seen_transmittance = after;
    }
    s = e;
  }
  return HALF_OPACITY_DEPTH != 0u ? vec4(NO_DEPTH, 0.0, 0.0, 0.0) : vec4(sum, 1.0 - transmittance);
}
