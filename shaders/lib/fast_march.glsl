// One packed volume along a ray: segments between samples s0, s1 with slopes d0, d1 along the ray; the value at the middle by the
// Hermite cubic, (s0 + s1) / 2 + (d0 - d1) L / 8; each half from the pre-integrated table (render/passes/preintegrated.h). A segment
// within a cube of plain bricks (render/mirror/plain_map.h) is as long as the ray's way through it.
layout(constant_id = 0) const uint SHADED = 0;  // 1: by the gradient of the cell, 2: by gradients made beforehand
layout(constant_id = 1) const uint SKIPS = 0;
layout(constant_id = 2) const uint OPAQUE = 0;

layout(binding = 3) uniform utexture3D packed_words;
layout(binding = 4) uniform utexture2D preintegrated;  // 256 x 256
layout(binding = 5) uniform utexture3D plain_map;
layout(binding = 8) uniform sampler3D gradients;  // render/mirror/gradient_volume.h
#include "shaders/lib/packed.glsl"

#define SMALL_BRICK 4.0

// x: sigma, yzw: colour
vec4 between(float a, float b) {
  const uvec2 e = texelFetch(preintegrated, ivec2(int(a + 0.5), int(b + 0.5)), 0).rg;
  return vec4(uintBitsToFloat(e.x), vec3(e.y & 2047u, e.y >> 11 & 2047u, e.y >> 22) * vec3(1.0 / 2047.0, 1.0 / 2047.0, 1.0 / 1023.0));
}

// As `lit` (lighting.glsl) for a headlight: colour * x + y. Codes hold nothing below a hundredth.
vec2 light_of(vec3 p, vec3 of_cell, vec3 towards_eye) {
  vec3 gradient = of_cell;
  if (SHADED == 2u) gradient = 255.0 * textureLod(gradients, (p + 0.5) / (frame.grids[0].hi + 1.0), 0.0).rgb - 128.0;
  const vec3 normal = dot(gradient, gradient) > 1e-4 ? frame.grids[0].world_gradient * gradient : vec3(0.0);
  const float length2 = dot(normal, normal);
  const float along = dot(normal, towards_eye);
  const float n2 = length2 > 0.0 ? min(1.0, along * along / length2) : 0.0;
  const float m = max(0.0, 2.0 * n2 - 1.0);
  const float m2 = m * m, m4 = m2 * m2, m8 = m4 * m4;
  return vec2(0.2 + 0.7 * sqrt(n2), 0.2 * m8 * m8 * m4);
}

// The premultiplied colour of the ray of pixel place q, up to depth `end`.
vec4 march_packed(vec2 q, float end) {
  const vec3 world = world_direction(q);
  const float world_per_depth = length(world);
  const LocalRay ray = local_ray(0, q);
  vec2 interval = visible_interval(0, ray, q);
  interval.y = min(interval.y, end);
  if (!(interval.x < interval.y)) return vec4(0.0);

  const float h = frame.step_world / world_per_depth;
  const vec3 inverse = safe_inverse(ray.direction);
  const vec3 ahead = mix(vec3(0.0), vec3(1.0), forward_of(ray.direction));
  const vec3 towards_eye = -world / world_per_depth;
  const vec3 hi = frame.grids[0].hi;
  float t = interval.x;
  float through = 1.0;
  vec3 sum = vec3(0.0);
  vec3 p = clamp(ray.origin + t * ray.direction, vec3(0.0), hi);
  PackedSample s = sample_packed(p);
  float slope = dot(s.gradient, ray.direction);
  vec2 light = vec2(1.0, 0.0);
  if (SHADED != 0u) light = light_of(p, s.gradient, towards_eye);
  while (t < interval.y && through > frame.termination) {
    // the segment's length
    float next = t + h;
    float curved = 1.0;
    if (SKIPS != 0u) {
      const vec3 brick = min(floor(p * (1.0 / SMALL_BRICK)), ceil(hi * (1.0 / SMALL_BRICK)) - 1.0);
      const float d = float(texelFetch(plain_map, ivec3(brick), 0).r);
      const vec3 way = (mix(brick + 1.0 - d, brick + d, ahead) * SMALL_BRICK - p) * inverse;
      const float leave = min(min(way.x, way.y), way.z);
      if (d > 0.0 && leave > h) {
        next = t + leave;
        curved = 0.0;
      }
    }
    if (next > interval.y - 1e-3 * h) next = interval.y;
    const float extent = next - t;
    p = clamp(ray.origin + next * ray.direction, vec3(0.0), hi);
    const PackedSample e = sample_packed(p);
    const float slope_end = dot(e.gradient, ray.direction);

    // its two halves
    const float middle = clamp(0.5 * (s.code + e.code) + curved * 0.125 * extent * (slope - slope_end), 0.0, 255.0);
    const vec4 first = between(s.code, middle), second = between(middle, e.code);
    const float half_length = -0.5 * 1.44269504 * extent * world_per_depth;
    const float half_way = through * exp2(first.x * half_length);
    const float after = half_way * exp2(second.x * half_length);
    if (SHADED != 0u) {
      const vec2 light_end = light_of(p, e.gradient, towards_eye);
      const vec2 l0 = mix(light, light_end, 0.25), l1 = mix(light, light_end, 0.75);
      sum += (through - half_way) * (first.yzw * l0.x + l0.y) + (half_way - after) * (second.yzw * l1.x + l1.y);
      light = light_end;
    } else {
      sum += (through - half_way) * first.yzw + (half_way - after) * second.yzw;
    }
    through = after;
    s = e;
    slope = slope_end;
    t = next;
  }
  return vec4(sum, 1.0 - through);
}
