// SPDX-License-Identifier: MIT
// Light of the environment (0.2 by default), diffuse 0.7, white specular 0.2 with exponent 20 of the mirrored ray (VTK: exponent 80 of the
// half vector). Two-sided: the normal is turned towards the camera. Without lights in the scene a headlight is at the camera. Without a
// normal only the environment remains. The includer declares `frame` with lights, environment and fog; if things darken each other in it, it
// sets `arriving` before it shades.
struct Lighting { vec3 diffuse, specular; };  // lit color = color * diffuse + specular

vec4 arriving = vec4(1.0);  // share of the lights 0 to 2 (rgb) and of the environment (a) that arrives at the shaded point

// Returns the share of light i that arrives.
float arriving_share(uint i) { return i < 3u ? arriving[i] : 1.0; }

Lighting without_normal() { return Lighting((frame.ground + 0.5 * (frame.sky - frame.ground)) * arriving.a, vec3(0.0)); }

// `normal`: unit vector.
vec3 environment_light(vec3 normal) {
  return (frame.ground + (0.5 + 0.5 * dot(normal, frame.zenith)) * (frame.sky - frame.ground)) * arriving.a;
}

Lighting lighting_of(vec3 normal, vec3 to_camera) {
  const float size = max(max(abs(normal.x), abs(normal.y)), abs(normal.z));
  if (!(size > 0.0)) return without_normal();
  normal /= size;  // gradients of 1e24 or 1e-24 would overflow or underflow when squared
  const float length2 = dot(normal, normal);
  if (!(length2 > 0.0)) return without_normal();
  const vec3 facing = normal * (inversesqrt(length2) * (dot(normal, to_camera) < 0.0 ? -1.0 : 1.0));
  Lighting sum = Lighting(environment_light(facing), vec3(0.0));
  const uint lights = frame.light_count + uint(to_camera.x < -2.0);  // as in as_nonuniform (rays.glsl)
  if (lights == 0u) {
    const float n = min(1.0, abs(dot(normal, to_camera)) * inversesqrt(length2));
    const float specular = max(0.0, 2.0 * n * n - 1.0);
    sum.diffuse += 0.7 * n;
    sum.specular += 0.2 * pow(specular, 20.0);
  } else {
    for (uint i = 0u; i < lights; ++i) {
      const vec3 l = frame.lights[i].direction, color = arriving_share(i) * frame.lights[i].color;
      const float d = dot(facing, l);
      const float specular = max(0.0, dot(2.0 * d * facing - l, to_camera));
      if (d > 0.0) {
        sum.diffuse += 0.7 * d * color;
        sum.specular += 0.2 * pow(specular, 20.0) * color;
      }
    }
  }
  return sum;
}

// Returns what a volume without shading scatters: the environment and 0.8 of each light, 1 under the default light.
Lighting scattered_light() {
  Lighting sum = without_normal();
  const uint lights = frame.light_count;
  if (lights == 0u) sum.diffuse += 0.8;
  for (uint i = 0u; i < lights; ++i) sum.diffuse += 0.8 * arriving_share(i) * frame.lights[i].color;
  return sum;
}

vec3 lit(vec3 color, Lighting light) { return color * light.diffuse + light.specular; }
vec3 lit(vec3 color, vec3 normal, vec3 to_camera) { return lit(color, lighting_of(normal, to_camera)); }

vec3 fogged(vec3 color, float t) {
  return mix(color, frame.fog.color, clamp((t - frame.fog.near) * frame.fog.per_depth, 0.0, 1.0) * frame.fog.max_opacity);
}
