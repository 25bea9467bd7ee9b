// SPDX-License-Identifier: MIT
// Light that arrives in the scene, computed by render/light. Include it after lighting.glsl. Where nothing is cast, `arriving` stays 1.
layout(binding = 63) uniform sampler3D light_grid;  // kLightGrid of render/raycast/grid_bindings.h

// Returns the texture coordinates along the ray of pixel coordinate q, at depth t.
vec3 light_at(vec2 q, float t) {
  return frame.light_grid.origin + frame.light_grid.origin_x * q.x + frame.light_grid.origin_y * q.y +
         t * (frame.light_grid.direction + frame.light_grid.direction_x * q.x + frame.light_grid.direction_y * q.y);
}

// Sets `arriving` inside of a medium.
void receive_in_volume(vec3 at) { arriving = textureLod(light_grid, at, 0.0); }

// Sets `arriving` at a surface, looked up in front of it: `normal` is turned towards the camera. The environment counts relative to an open,
// even surface. Loops with at most one iteration replace branches on uniforms (rays.glsl).
void receive_on_surface(vec3 at, vec3 normal, vec3 to_camera) {
  for (float on = frame.light_grid.is_on + float(to_camera.x < -2.0); on > 0.0; on = 0.0) {
    const vec3 outwards = normalize(normal) * (dot(normal, to_camera) < 0.0 ? -1.0 : 1.0);
    arriving = textureLod(light_grid, at + frame.light_grid.from_normal * outwards, 0.0);
    arriving.a = min(1.0, frame.light_grid.open_gain * arriving.a);
  }
}
