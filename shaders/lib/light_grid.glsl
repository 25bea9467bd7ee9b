// SPDX-License-Identifier: MIT
// Light that arrives in the scene, computed by render/light. Include it after lighting.glsl. Where nothing is cast, `arriving` stays 1. The
// lower half of the texture has the shares of `arriving`, the upper one `arriving_from` (world axes, from -1 to 1) and the openness, by which
// all are multiplied: cells that surfaces fill do not count.
layout(binding = 63) uniform sampler3D light_grid;  // kLightGrid of render/raycast/grid_bindings.h

// Returns the texture coordinates along the ray of pixel coordinate q, at depth t.
vec3 light_at(vec2 q, float t) {
  return frame.light_grid.origin + frame.light_grid.origin_x * q.x + frame.light_grid.origin_y * q.y +
         t * (frame.light_grid.direction + frame.light_grid.direction_x * q.x + frame.light_grid.direction_y * q.y);
}

#define LAST_LOOKUP 4  // at a surface, cells in front of it; the first one that is open counts
#define OPEN_ENOUGH 0.2

// Sets `arriving` inside of a medium. Returns the openness.
float receive_in_volume(vec3 at) {
  at.z = 0.5 * clamp(at.z, frame.light_grid.half_plane, 1.0 - frame.light_grid.half_plane);
  const vec4 shares = textureLod(light_grid, at, 0.0), vector = textureLod(light_grid, at + vec3(0.0, 0.0, 0.5), 0.0);
  const float per_open = 1.0 / max(vector.a, 1.0 / 255.0);
  arriving = min(vec4(1.0), per_open * shares);
  arriving_from = frame.light_grid.is_on * per_open * (frame.light_grid.from_world * (255.0 / 127.0 * vector.rgb - 128.0 / 127.0));
  return vector.a;
}

// Sets `arriving` at a surface, looked up in front of it, in the direction `outwards`, from `first` cells on. Loops with at most one iteration replace branches on
// uniforms (rays.glsl).
void receive_in_front(vec3 at, vec3 outwards, int first) {
  float on = frame.light_grid.is_on + float(at.x < -1e30);
  const vec3 step = frame.light_grid.from_normal * normalize(outwards);
  for (int k = first; on > 0.0; ++k)
    if (receive_in_volume(at + float(k) * step) > OPEN_ENOUGH || k >= LAST_LOOKUP) on = 0.0;
}

// The same, with a normal that is turned towards the camera.
void receive_on_surface(vec3 at, vec3 normal, vec3 to_camera) { receive_in_front(at, dot(normal, to_camera) < 0.0 ? -normal : normal, 1); }

// Sets `arriving` at an isosurface, seen from its higher side or not: the cells of the higher side are filled.
void receive_on_level(vec3 at, vec3 gradient, bool from_above) { receive_in_front(at, from_above ? gradient : -gradient, from_above ? 2 : 1); }
