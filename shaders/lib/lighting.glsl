// SPDX-License-Identifier: MIT
// Light of the environment (0.2 by default), diffuse 0.7, white specular 0.2 with exponent 20 of the mirrored ray (VTK: exponent 80 of the
// half vector); with linear radiance diffuse 1 and no highlight (frame.look). Two-sided: the normal is turned towards the camera. Without
// lights in the scene a headlight is at the camera. Without a normal only the environment remains, or what a volume scatters. The includer
// declares `frame` with lights, environment, look and fog; if things darken each other in it, it sets `arriving` before it shades.
#include "shaders/lib/linear_color.glsl"
struct Lighting { vec3 diffuse, specular; };  // lit color = color * diffuse + specular

vec4 arriving = vec4(1.0);  // share of the lights 0 to 2 (rgb) and of the environment (a, mean of all sides) that arrives at the shaded point
vec3 arriving_from = vec3(0.0);  // change of the environment's share with the direction that it comes from, in the axes of normals

// Returns the share of light i that arrives.
float arriving_share(uint i) { return i < 3u ? arriving[i] : 1.0; }

// Returns what is scattered in all directions alike. Loop bounds are not uniform, as in as_nonuniform (rays.glsl).
Lighting without_normal(vec3 to_camera) {
  Lighting sum = Lighting((frame.ground + 0.5 * (frame.sky - frame.ground)) * arriving.a, vec3(0.0));
  const uint lights = frame.light_count * uint(frame.look.is_linear) + uint(to_camera.x < -2.0);
  for (uint i = 0u; i < lights; ++i) sum.diffuse += frame.look.scattered * arriving_share(i) * frame.lights[i].color;
  return sum;
}

// Returns what a surface receives, by Lambert's law. `normal`: unit vector.
vec3 environment_light(vec3 normal) {
  return (frame.ground + (0.5 + frame.look.zenith_share * dot(normal, frame.zenith)) * (frame.sky - frame.ground)) * clamp(arriving.a + 2.0 / 3.0 * dot(arriving_from, normal), 0.0, 1.0);
}

Lighting lighting_of(vec3 normal, vec3 to_camera) {
  const float size = max(max(abs(normal.x), abs(normal.y)), abs(normal.z));
  if (!(size > 0.0)) return without_normal(to_camera);
  normal /= size;  // gradients of 1e24 or 1e-24 would overflow or underflow when squared
  const float length2 = dot(normal, normal);
  if (!(length2 > 0.0)) return without_normal(to_camera);
  const vec3 facing = normal * (inversesqrt(length2) * (dot(normal, to_camera) < 0.0 ? -1.0 : 1.0));
  Lighting sum = Lighting(environment_light(facing), vec3(0.0));
  const uint lights = frame.light_count + uint(to_camera.x < -2.0);  // as in as_nonuniform (rays.glsl)
  if (lights == 0u) {
    const float n = min(1.0, abs(dot(normal, to_camera)) * inversesqrt(length2));
    const float specular = max(0.0, 2.0 * n * n - 1.0);
    sum.diffuse += frame.look.diffuse * n;
    sum.specular += frame.look.specular * pow(specular, 20.0);
  } else {
    for (uint i = 0u; i < lights; ++i) {
      const vec3 l = frame.lights[i].direction, color = arriving_share(i) * frame.lights[i].color;
      const float d = dot(facing, l);
      const float specular = max(0.0, dot(2.0 * d * facing - l, to_camera));
      if (d > 0.0) {
        sum.diffuse += frame.look.diffuse * d * color;
        sum.specular += frame.look.specular * pow(specular, 20.0) * color;
      }
    }
  }
  return sum;
}

// Returns Henyey and Greenstein's phase function times 4 pi, by the cosine of the angle by which light is turned.
float phase(float g, float cosine) {
  const float base = 1.0 + g * g - 2.0 * g * cosine;
  return (1.0 - g * g) * inversesqrt(base * base * base);
}

// Returns what a volume scatters towards the camera by its phase function of anisotropy g: the environment, and a share of each light.
Lighting scattered_light(float g, vec3 to_camera) {
  Lighting sum = Lighting((frame.ground + (0.5 - frame.look.zenith_share * g * dot(to_camera, frame.zenith)) * (frame.sky - frame.ground)) * arriving.a, vec3(0.0));
  const uint lights = frame.light_count + uint(to_camera.x < -2.0);
  if (lights == 0u) sum.diffuse += frame.look.scattered * phase(g, -1.0);
  for (uint i = 0u; i < lights; ++i) {
    const float turned = phase(g, -dot(to_camera, frame.lights[i].direction));
    sum.diffuse += frame.look.scattered * turned * arriving_share(i) * frame.lights[i].color;
  }
  return sum;
}

// Returns the light of a shaded volume: the share that its gradient reflects, the rest by the phase function.
Lighting with_phase(Lighting reflected, float share, float g, vec3 to_camera) {
  for (float rest = 1.0 - share + float(to_camera.x < -2.0); rest > 0.0; rest = 0.0) {
    const Lighting turned = scattered_light(g, to_camera);
    reflected.diffuse = mix(turned.diffuse, reflected.diffuse, share);
    reflected.specular *= share;
  }
  return reflected;
}

vec3 lit(vec3 color, Lighting light) { return color * light.diffuse + light.specular; }
vec3 lit(vec3 color, vec3 normal, vec3 to_camera) { return lit(color, lighting_of(normal, to_camera)); }

// Returns the color of a vertex in the encoding of the light. A loop with at most one iteration replaces a branch (rays.glsl).
vec3 vertex_color(vec3 color) {
  for (float on = frame.look.is_linear + float(color.r < -1e30); on > 0.0; on = 0.0) color = to_linear(color);
  return color;
}

// Returns a color of lit objects in the display encoding.
vec3 displayed_color(vec3 color) {
  for (float on = frame.look.is_linear + float(color.r < -1e30); on > 0.0; on = 0.0) color = to_display(color);
  return color;
}

vec3 fogged(vec3 color, float t) {
  return mix(color, frame.fog.color, clamp((t - frame.fog.near) * frame.fog.per_depth, 0.0, 1.0) * frame.fog.max_opacity);
}
