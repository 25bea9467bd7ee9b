// SPDX-License-Identifier: MIT
// Way of a ray from cell to cell.

// Ray with its axes flipped so that it moves towards increasing coordinates: p' = -p on a flipped axis, and cell c becomes c' = ~c. Blocks
// of a power of two remain blocks. The ray never exits along an axis without movement.
struct FlippedRay {
  vec3 origin, direction, inverse, still_offset;
  ivec3 turned;  // -1 on a flipped axis
  ivec3 end;     // one beyond the last cell
};

// lo, hi: the first cell, and one beyond the last one.
FlippedRay make_flipped_ray(LocalRay ray, ivec3 lo, ivec3 hi) {
  const bvec3 stands = lessThan(abs(ray.direction), vec3(MIN_DIRECTION)), backward = lessThan(ray.direction, vec3(0.0));
  FlippedRay flipped;
  flipped.turned = mix(ivec3(0), ivec3(-1), backward);
  flipped.origin = mix(ray.origin, -ray.origin, backward);
  flipped.direction = abs(ray.direction);
  flipped.inverse = mix(1.0 / flipped.direction, vec3(0.0), stands);
  flipped.still_offset = mix(vec3(0.0), vec3(NO_DEPTH), stands);
  flipped.end = mix(hi, -lo, backward);
  return flipped;
}

// Entry of the ray into a cell; `entered`: the axis of the face that it came through, if any.
struct CellTraversal {
  ivec3 cell;  // in flipped coordinates
  float t;
  bvec3 entered;
};

vec3 exits(FlippedRay flipped, ivec3 end) { return (vec3(end) - flipped.origin) * flipped.inverse + flipped.still_offset; }
float min_component(vec3 v) { return min(min(v.x, v.y), v.z); }
bvec3 min_axis(vec3 v, float smallest) {
  const bool x = v.x == smallest, y = !x && v.y == smallest;
  return bvec3(x, y, !(x || y));
}

// Advances to the ray's exit from the box of cells around the current cell that ends before `end`. Beyond the domain's last cell, t is
// beyond the ray's end.
void advance_past(inout CellTraversal traversal, FlippedRay flipped, ivec3 end) {
  end = min(end, flipped.end);
  const vec3 leave = exits(flipped, end);
  const float out_at = min_component(leave);
  traversal.entered = min_axis(leave, out_at);
  traversal.cell = mix(clamp(ivec3(floor(flipped.origin + out_at * flipped.direction)), traversal.cell, end - 1), end, traversal.entered);
  traversal.t = max(traversal.t, out_at);
}

// Segment of the ray in the current cell: its ends as positions in the cell and as depths.
struct RaySegment {
  vec3 a, b;
  float from, to;
};

RaySegment segment_in_cell(CellTraversal traversal, FlippedRay flipped, float to) {
  const vec3 leave = exits(flipped, traversal.cell + 1);
  const float out_at = min_component(leave), end = clamp(out_at, traversal.t, to);
  const bool leaves = end == max(out_at, traversal.t);  // false: the segment ends inside the cell
  const bvec3 left = leaves ? min_axis(leave, out_at) : bvec3(false);
  const vec3 a = mix(clamp(flipped.origin + traversal.t * flipped.direction - vec3(traversal.cell), 0.0, 1.0), vec3(0.0), traversal.entered);
  const vec3 b = mix(clamp(flipped.origin + end * flipped.direction - vec3(traversal.cell), 0.0, 1.0), vec3(1.0), left);
  const bvec3 turned = lessThan(flipped.turned, ivec3(0));
  return RaySegment(mix(a, 1.0 - a, turned), mix(b, 1.0 - b, turned), traversal.t, end);
}
