// The ray of a pixel, and where it meets a grid's domain. Depths as in shared/frame.h.
struct LocalRay {
  vec3 origin, direction;  // local position at depth t: origin + t direction
};

vec2 pixel_place() { return gl_FragCoord.xy - frame.half_size; }

LocalRay local_ray(int i, vec2 q) {
  LocalRay ray;
  ray.origin = frame.grids[i].origin + frame.grids[i].origin_x * q.x + frame.grids[i].origin_y * q.y;
  ray.direction = frame.grids[i].direction + frame.grids[i].direction_x * q.x + frame.grids[i].direction_y * q.y;
  return ray;
}

// World vector of one unit of depth along the ray of pixel place q (y down).
vec3 world_direction(vec2 q) { return frame.forward + frame.right * (q.x * frame.slope.x) - frame.up * (q.y * frame.slope.y); }

vec3 safe_inverse(vec3 d) {
  const vec3 least = vec3(1e-30);
  return 1.0 / mix(d, mix(-least, least, greaterThanEqual(d, vec3(0.0))), lessThan(abs(d), least));
}

// Exact entry and exit of the domain; entry >= exit where the ray misses it.
vec2 domain_interval(int i, LocalRay ray) {
  const vec3 inverse = safe_inverse(ray.direction);
  const vec3 a = (frame.grids[i].lo - ray.origin) * inverse, b = (frame.grids[i].hi - ray.origin) * inverse;
  const vec3 near = min(a, b), far = max(a, b);
  return vec2(max(max(near.x, near.y), near.z), min(min(far.x, far.y), far.z));
}

float buffer_depth(float t) {
  const float z = t + frame.reference_depth;
  if (frame.orthographic != 0u) return (frame.depth_far - z) / (frame.depth_far - frame.depth_near);
  return clamp(frame.depth_near / max(z, 1e-30), 0.0, 1.0);
}

// Depth at which the ray leaves the cube of empty bricks around the brick of `p` (at distance `d` the next active one), from p.
float leave_empty(LocalRay ray, vec3 p, ivec3 brick, int d) {
  const vec3 inverse = safe_inverse(ray.direction);
  const vec3 lo = vec3((brick - (d - 1)) * BRICK), hi = vec3((brick + d) * BRICK);
  const vec3 t = (mix(lo, hi, greaterThan(ray.direction, vec3(0.0))) - p) * inverse;
  return min(min(t.x, t.y), t.z);
}
