// One packed volume along a ray: segments between samples s0, s1 with slopes d0, d1 along the ray; the value at the middle by the
// Hermite cubic, (s0 + s1) / 2 + (d0 - d1) L / 8; each half from the pre-integrated table (render/raycast/transfer_tables.h). A segment
// within a cube of plain bricks (render/mirror/brick_map.h) is as long as the ray's way through it.
layout(constant_id = 0) const uint SHADED = 0;  // 1: by the gradient of the cell, 2: by gradients made beforehand
layout(constant_id = 1) const uint SKIPS = 0;
layout(constant_id = 2) const uint OPAQUE = 0;

layout(binding = 3) uniform utexture3D packed_words;
layout(binding = 4) uniform utexture2D preintegrated;  // 256 x 256
layout(binding = 5) uniform utexture3D plain_map;
layout(binding = 8) uniform sampler3D gradients;  // render/mirror/packed_volume.h
#include "shaders/lib/packed.glsl"

#define SMALL_BRICK 4.0

// x: sigma, yzw: colour
vec4 between(float a, float b) {
  const uvec2 e = texelFetch(preintegrated, ivec2(int(a + 0.5), int(b + 0.5)), 0).rg;
  return vec4(uintBitsToFloat(e.x), vec3(e.y & 2047u, e.y >> 11 & 2047u, e.y >> 22) * vec3(1.0 / 2047.0, 1.0 / 2047.0, 1.0 / 1023.0));
}

// As `lit` (lighting.glsl) for a headlight, by the cosine between normal and ray: colour * x + y.
vec2 light_at(float n, float n2) {
  const float m = max(0.0, 2.0 * n2 - 1.0);
  const float m2 = m * m, m4 = m2 * m2, m8 = m4 * m4;
  return vec2(0.2 + 0.7 * n, 0.2 * m8 * m8 * m4);
}

// The gradient at a sample, codes a world length; w: the share of it that had to be shortened. Codes hold nothing below a hundredth.
vec4 normal_at(vec3 p, vec3 of_cell) {
  if (SHADED != 2u) return vec4(frame.grids[0].world_gradient * of_cell, 0.0);
  const vec4 texel = textureLod(gradients, (p + 0.5) / (frame.grids[0].hi + 1.0), 0.0);
  const vec3 counts = 255.0 * texel.rgb - 128.0;
  return dot(counts, counts) > 1e-4 ? vec4(frame.grids[0].world_gradient * (lattice.gradient_unit * counts), texel.a) : vec4(0.0);
}

// The mean light over half a segment along which the derivative goes from a to b, by the squared length of the gradient across the ray:
// the derivative is known far better than its direction is, and lights both sides alike.
vec2 light_between(float a, float b, float across2) {
  const float squares = (a * a + a * b + b * b) * (1.0 / 3.0), length2 = across2 + squares;
  const float sizes = a * b >= 0.0 ? 0.5 * abs(a + b) : 0.5 * (a * a + b * b) / abs(b - a);
  return length2 > 0.0 ? light_at(min(1.0, sizes * inversesqrt(length2)), squares / length2) : vec2(0.2, 0.0);
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
  const vec3 along_ray = world / world_per_depth;
  const vec3 hi = frame.grids[0].hi;
  float t = interval.x;
  float through = 1.0;
  vec3 sum = vec3(0.0);
  vec3 p = clamp(ray.origin + t * ray.direction, vec3(0.0), hi);
  PackedSample s = sample_packed(p);
  float slope = dot(s.gradient, ray.direction);
  // shading: the gradient, its share along the ray and the square of the rest
  vec4 normal = vec4(0.0);
  float along = 0.0, across2 = 0.0;
  if (SHADED != 0u) {
    normal = normal_at(p, s.gradient);
    along = dot(normal.xyz, along_ray);
    across2 = dot(normal.xyz, normal.xyz) - along * along;
  }
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
      const vec4 normal_end = normal_at(p, e.gradient);
      const float along_end = dot(normal_end.xyz, along_ray), across2_end = dot(normal_end.xyz, normal_end.xyz) - along_end * along_end;
      const float both = dot(normal.xyz, normal_end.xyz) - along * along_end, ends = along + along_end;
      const float rise = (e.code - s.code) / (extent * world_per_depth);
      float along_middle = SHADED == 1u ? 1.5 * rise - 0.25 * ends : 0.75 * rise + 0.125 * ends;
      along_middle = mix(along_middle, 0.5 * ends, max(normal.w, normal_end.w));
      const vec2 l0 = light_between(along, along_middle, max(0.0, 0.5625 * across2 + 0.375 * both + 0.0625 * across2_end));
      const vec2 l1 = light_between(along_middle, along_end, max(0.0, 0.0625 * across2 + 0.375 * both + 0.5625 * across2_end));
      normal = normal_end;
      along = along_end;
      across2 = across2_end;
      sum += (through - half_way) * (first.yzw * l0.x + l0.y) + (half_way - after) * (second.yzw * l1.x + l1.y);
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
