// SPDX-License-Identifier: MIT
// Ray of a pixel, and its interval in a grid's domain. Depths as in shared/frame.h.
struct LocalRay {
  vec3 origin, direction;  // local position at depth t: origin + t direction
};

vec2 pixel_position() { return frame.spacing * gl_FragCoord.xy + frame.first - frame.axis; }

LocalRay local_ray(int i, vec2 q) {
  LocalRay ray;
  ray.origin = frame.grids[i].origin + frame.grids[i].origin_x * q.x + frame.grids[i].origin_y * q.y;
  ray.direction = frame.grids[i].direction + frame.grids[i].direction_x * q.x + frame.grids[i].direction_y * q.y;
  return ray;
}

// Returns the world vector of one unit of depth along the ray of pixel coordinate q (y down).
vec3 world_direction(vec2 q) { return frame.forward + frame.right * (q.x * frame.slope.x) - frame.up * (q.y * frame.slope.y); }

#define MIN_DIRECTION 1e-30

// Returns 1 / d; a component of zero counts as a small positive one, as in is_forward.
vec3 safe_inverse(vec3 d) { return 1.0 / mix(d, vec3(MIN_DIRECTION), lessThan(abs(d), vec3(MIN_DIRECTION))); }
bvec3 is_forward(vec3 d) { return greaterThan(d, vec3(-MIN_DIRECTION)); }

// Returns the exact entry and exit of the domain; entry >= exit: the ray misses it.
vec2 domain_interval(int i, LocalRay ray) {
  const vec3 inverse = safe_inverse(ray.direction);
  const vec3 lo = frame.grids[i].domain_lo, hi = frame.grids[i].domain_hi;
  const vec3 a = (lo - ray.origin) * inverse, b = (hi - ray.origin) * inverse;
  vec3 near = min(a, b), far = max(a, b);
  for (int axis = 0; axis < 3; ++axis)
    if (abs(ray.direction[axis]) < MIN_DIRECTION) {
      const bool inside = ray.origin[axis] >= lo[axis] && ray.origin[axis] <= hi[axis];
      near[axis] = inside ? -NO_DEPTH : NO_DEPTH;
      far[axis] = -near[axis];
    }
  return vec2(max(max(near.x, near.y), near.z), min(min(far.x, far.y), far.z));
}

// Returns a uniform number as a loop bound that appears to depend on the pixel. The CPU driver rebuilds a shader that branches on uniforms
// only at every draw (milliseconds; 0.1 s without its disk cache).
uint as_nonuniform(uint number, vec2 q) { return number + uint(q.x < -1e30); }

// Returns the visible interval of a grid's domain: in front of the camera, within the clip planes. Entry >= exit: it is empty.
vec2 visible_interval(int i, LocalRay ray, vec2 q) {
  vec2 interval = domain_interval(i, ray);
  interval.x = max(interval.x, frame.front_depth);
  const uint planes = as_nonuniform(frame.grids[i].is_clipped * frame.clip_count, q);
  for (uint k = 0u; k < planes; ++k) {
    const float at = frame.clips[k].at + frame.clips[k].at_x * q.x + frame.clips[k].at_y * q.y;
    const float along = frame.clips[k].along + frame.clips[k].along_x * q.x + frame.clips[k].along_y * q.y;
    const float t = abs(along) < MIN_DIRECTION ? (at >= 0.0 ? -NO_DEPTH : NO_DEPTH) : -at / along;
    if (along >= -MIN_DIRECTION) interval.x = max(interval.x, t);
    else interval.y = min(interval.y, t);
  }
  return interval;
}

float buffer_depth(float t) {
  const float z = t + frame.reference_depth;
  const float parallel = float(frame.orthographic);
  return parallel * (frame.depth_far - z) / (frame.depth_far - frame.depth_near) + (1.0 - parallel) * clamp(frame.depth_near / max(z, 1e-30), 0.0, 1.0);
}

// Returns the depth from p to the ray's exit from the cube of empty bricks around p's brick; `d`: distance to the nearest active brick.
float exit_empty_region(LocalRay ray, vec3 p, ivec3 brick, int d) {
  const vec3 inverse = safe_inverse(ray.direction);
  const vec3 lo = vec3((brick - (d - 1)) * BRICK_SIZE), hi = vec3((brick + d) * BRICK_SIZE);
  const vec3 t = (mix(lo, hi, is_forward(ray.direction)) - p) * inverse;
  return min(min(t.x, t.y), t.z);
}
