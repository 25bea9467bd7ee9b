// SPDX-License-Identifier: MIT
// Constants and the transfer function of the fast raycast, pre-integrated over pairs of codes (render/raycast/preintegrated.h), and the
// light of a segment.
#include "shaders/lib/lighting.glsl"
#include "shaders/lib/light_grid.glsl"
layout(constant_id = 0) const uint SHADED = 0;  // 1: by the gradient of the cell, 2: by precomputed gradients
layout(constant_id = 1) const uint SKIPS_EMPTY = 0;
layout(constant_id = 2) const uint HAS_OPAQUE = 0;
layout(constant_id = 10) const uint INTERPOLATES_TABLE = 0;  // between codes
layout(constant_id = 11) const uint HAS_LIGHTS = 0;  // 1: lights or an environment of the scene; 2: things darken each other. 0: a headlight
layout(constant_id = 7) const uint HALF_OPACITY_DEPTH = 0;  // output: depth of half transmittance instead of a color

layout(binding = 4) uniform utexture2D preintegrated;  // 256 x 256 for each channel
float seen_transmittance = 1.0;  // of the ray, in front of the segment

vec4 table_entry(int channel, ivec2 codes) {
  const uvec2 e = texelFetch(preintegrated, codes + ivec2(0, 256 * channel), 0).rg;
  return vec4(uintBitsToFloat(e.x), vec3(e.y & 2047u, e.y >> 11 & 2047u, e.y >> 22) * vec3(1.0 / 2047.0, 1.0 / 2047.0, 1.0 / 1023.0));
}

// Returns x: sigma, yzw: color, of one of several tables.
vec4 lookup_preintegrated(int channel, float a, float b) {
  if (INTERPOLATES_TABLE == 0u) return table_entry(channel, ivec2(int(a + 0.5), int(b + 0.5)));
  const vec2 at = vec2(a, b), base = min(floor(at), vec2(254.0)), f = at - base;
  vec4 mean = vec4(0.0);  // color times sigma
  for (int k = 0; k < 4; ++k) {
    const ivec2 corner = ivec2(k & 1, k >> 1);
    const vec2 weights = mix(1.0 - f, f, vec2(corner));
    const vec4 e = table_entry(channel, ivec2(base) + corner);
    mean += weights.x * weights.y * e.x * vec4(1.0, e.yzw);
  }
  return vec4(mean.x, mean.yzw / max(mean.x, 1e-30));
}

vec4 lookup_preintegrated(float a, float b) { return lookup_preintegrated(0, a, b); }

// Returns the light of a headlight as in lighting.glsl, from the cosine n of normal and ray.
Lighting headlight_at(float n, float n2) {
  const float m = max(0.0, 2.0 * n2 - 1.0);
  const float m2 = m * m, m4 = m2 * m2, m8 = m4 * m4;
  return Lighting(vec3(0.2 + 0.7 * n), vec3(0.2 * m8 * m8 * m4));
}

Lighting mean_light(Lighting a, Lighting b) { return Lighting(0.5 * (a.diffuse + b.diffuse), 0.5 * (a.specular + b.specular)); }

float light_until = -NO_DEPTH;  // depth up to which `arriving` holds

// Sets `arriving` for the segment from depth t0 to t1 of pixel coordinate q, if it is visible: anew after half a cell of the light grid. A
// loop with at most one iteration replaces a branch (rays.glsl).
void receive_between(vec2 q, float t0, float t1, bool is_visible) {
  if (HAS_LIGHTS == 2u)
    for (bool anew = is_visible && t1 > light_until; anew; anew = false) {
      light_until = max(t1, t0 + frame.light_grid.half_cell);
      receive_in_volume(light_at(q, 0.5 * (t0 + light_until)));
    }
}

// Returns the position where transmittance falls to 0.5 in a segment of constant sigma, as a share of its length; before > 0.5 >= after.
float half_transmittance_position(float before, float after) { return clamp(log(2.0 * before) / log(before / max(after, 1e-30)), 0.0, 1.0); }
