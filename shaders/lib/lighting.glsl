// SPDX-License-Identifier: MIT
// Ambient 0.2, diffuse 0.7, white specular 0.2 with exponent 20 of the mirrored ray (VTK: exponent 80 of the half vector). Two-sided: the
// normal is turned towards the camera. Without lights in the scene a headlight is at the camera. Without a normal only the ambient term
// remains. The includer declares `frame` with light_count, lights and fog.
struct Lighting { vec3 diffuse, specular; };  // lit color = color * diffuse + specular
const Lighting kOnlyAmbient = Lighting(vec3(0.2), vec3(0.0));

Lighting lighting_of(vec3 normal, vec3 to_camera) {
  const float size = max(max(abs(normal.x), abs(normal.y)), abs(normal.z));
  if (!(size > 0.0)) return kOnlyAmbient;
  normal /= size;  // gradients of 1e24 or 1e-24 would overflow or underflow when squared
  const float length2 = dot(normal, normal);
  if (!(length2 > 0.0)) return kOnlyAmbient;
  Lighting sum = kOnlyAmbient;
  const uint lights = frame.light_count + uint(to_camera.x < -2.0);  // as in as_nonuniform (rays.glsl)
  if (lights == 0u) {
    const float n = min(1.0, abs(dot(normal, to_camera)) * inversesqrt(length2));
    const float specular = max(0.0, 2.0 * n * n - 1.0);
    sum.diffuse += 0.7 * n;
    sum.specular += 0.2 * pow(specular, 20.0);
  } else {
    const vec3 n = normal * (inversesqrt(length2) * (dot(normal, to_camera) < 0.0 ? -1.0 : 1.0));
    for (uint i = 0u; i < lights; ++i) {
      const vec3 l = frame.lights[i].direction;
      const float d = dot(n, l);
      const float specular = max(0.0, dot(2.0 * d * n - l, to_camera));
      if (d > 0.0) {
        sum.diffuse += 0.7 * d * frame.lights[i].color;
        sum.specular += 0.2 * pow(specular, 20.0) * frame.lights[i].color;
      }
    }
  }
  return sum;
}

vec3 lit(vec3 color, vec3 normal, vec3 to_camera) {
  const Lighting light = lighting_of(normal, to_camera);
  return color * light.diffuse + light.specular;
}

vec3 fogged(vec3 color, float t) {
  return mix(color, frame.fog.color, clamp((t - frame.fog.near) * frame.fog.per_depth, 0.0, 1.0) * frame.fog.max_opacity);
}
