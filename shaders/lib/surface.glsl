// SPDX-License-Identifier: MIT
// First crossing of a level along a ray. In a trilinear cell the value along the ray is a cubic; its Bernstein coefficients are exact
// values of the polar form (blossom) F of the trilinear function, with a and b the entry and exit in the cell:
//   B0 = F(a,a,a)   B1 = (F(b,a,a) + F(a,b,a) + F(a,a,b)) / 3   B2 = (F(a,b,b) + F(b,a,b) + F(b,b,a)) / 3   B3 = F(b,b,b)
// If all have one sign, there is no root. Else the cubic is split at its extrema, and the first monotonic piece with a change of sign is
// bracketed. Watertight: the value at a face is equal in both cells (the coordinate across the face is exactly 0 or 1, and `precise`
// forbids contraction), so that no change of sign is lost between them. A cell whose corners lie on one side of the level is skipped.

float lerp_exact(float a, float b, float w) {
  precise float r = a * (1.0 - w) + b * w;
  return r;
}
vec2 lerp_exact(vec2 a, vec2 b, float w) {
  precise vec2 r = a * (1.0 - w) + b * w;
  return r;
}
vec4 lerp_exact(vec4 a, vec4 b, float w) {
  precise vec4 r = a * (1.0 - w) + b * w;
  return r;
}

vec4 cell_cubic(vec4 lo, vec4 hi, vec3 a, vec3 b) {
  const vec4 za = lerp_exact(lo, hi, a.z), zb = lerp_exact(lo, hi, b.z);
  const vec2 ya_za = lerp_exact(za.xy, za.zw, a.y), yb_zb = lerp_exact(zb.xy, zb.zw, b.y);
  const vec2 yb_za = mix(za.xy, za.zw, b.y), ya_zb = mix(zb.xy, zb.zw, a.y);
  const float aaa = lerp_exact(ya_za.x, ya_za.y, a.x), baa = mix(ya_za.x, ya_za.y, b.x);
  const float aba = mix(yb_za.x, yb_za.y, a.x), bba = mix(yb_za.x, yb_za.y, b.x);
  const float aab = mix(ya_zb.x, ya_zb.y, a.x), bab = mix(ya_zb.x, ya_zb.y, b.x);
  const float abb = mix(yb_zb.x, yb_zb.y, a.x), bbb = lerp_exact(yb_zb.x, yb_zb.y, b.x);
  return vec4(aaa, (baa + aba + aab) / 3.0, (abb + bab + bba) / 3.0, bbb);
}

float cubic_at(vec4 c, float u) {
  const vec3 p = mix(c.xyz, c.yzw, u);
  const vec2 q = mix(p.xy, p.yz, u);
  return mix(q.x, q.y, u);
}

// Monotonic piece of a cubic with a change of sign: its ends and the values there.
struct Bracket {
  float a, b, fa, fb;
};

// Finds the first such piece in 0..1; returns false if there is none.
bool first_bracket(vec4 c, out Bracket bracket) {
  bracket = Bracket(0.0, 1.0, c.x, c.w);
  // all coefficients on one side: no root
  if (min(min(c.x, c.y), min(c.z, c.w)) >= 0.0 || max(max(c.x, c.y), max(c.z, c.w)) < 0.0) return false;
  // extrema: roots of the derivative, a quadratic with the Bernstein coefficients d
  const vec3 d = c.yzw - c.xyz;
  const float qa = d.x - 2.0 * d.y + d.z, qb = d.y - d.x, qc = d.x;
  const float discriminant = qb * qb - qa * qc;
  if (discriminant > 0.0) {
    const float w = -(qb + (qb >= 0.0 ? 1.0 : -1.0) * sqrt(discriminant));
    const float r0 = abs(qa) > 0.0 ? w / qa : 1.0, r1 = abs(w) > 0.0 ? qc / w : 1.0;
    const vec2 cuts = clamp(vec2(min(r0, r1), max(r0, r1)), 0.0, 1.0);
    const float f1 = cubic_at(c, cuts.x), f2 = cubic_at(c, cuts.y);
    if ((c.x >= 0.0) != (f1 >= 0.0)) bracket = Bracket(0.0, cuts.x, c.x, f1);
    else if ((f1 >= 0.0) != (f2 >= 0.0)) bracket = Bracket(cuts.x, cuts.y, f1, f2);
    else bracket = Bracket(cuts.y, 1.0, f2, c.w);
  }
  return (bracket.fa >= 0.0) != (bracket.fb >= 0.0);
}

// Returns the root: Newton iteration from the secant's root, with bisection where a step leaves the bracket.
float find_root(vec4 c, Bracket bracket) {
  const vec3 d = 3.0 * (c.yzw - c.xyz);
  float a = bracket.a, b = bracket.b;
  float u = clamp(a - bracket.fa * (b - a) / (bracket.fb - bracket.fa), a, b);
  float moved = 1.0;
  for (int i = 0; i < 24 && moved > 1e-5; ++i) {
    const float f = cubic_at(c, u);
    if ((f >= 0.0) == (bracket.fb >= 0.0)) b = u;
    else a = u;
    const vec2 slopes = mix(d.xy, d.yz, u);
    const float next = u - f / mix(slopes.x, slopes.y, u);
    const float bounded = next >= a && next <= b ? next : 0.5 * (a + b);
    moved = abs(bounded - u);
    u = bounded;
  }
  return u;
}

// Ray with its axes flipped so that it moves towards increasing coordinates: p' = -p on a flipped axis, and cell c becomes c' = ~c. Blocks
// of a power of two remain blocks. The ray never exits along an axis without movement.
struct FlippedRay {
  vec3 origin, direction, inverse, still_offset;
  ivec3 turned;  // -1 on a flipped axis
  ivec3 end;     // one beyond the last cell
};

FlippedRay make_flipped_ray(int i, LocalRay ray) {
  const bvec3 stands = lessThan(abs(ray.direction), vec3(MIN_DIRECTION)), backward = lessThan(ray.direction, vec3(0.0));
  FlippedRay flipped;
  flipped.turned = mix(ivec3(0), ivec3(-1), backward);
  flipped.origin = mix(ray.origin, -ray.origin, backward);
  flipped.direction = abs(ray.direction);
  flipped.inverse = mix(1.0 / flipped.direction, vec3(0.0), stands);
  flipped.still_offset = mix(vec3(0.0), vec3(NO_DEPTH), stands);
  flipped.end = mix(ivec3(frame.grids[i].hi), -ivec3(frame.grids[i].lo), backward);
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

bool holds_level(vec4 lo, vec4 hi) {
  const vec4 low = min(lo, hi), high = max(lo, hi);
  return min(min(low.x, low.y), min(low.z, low.w)) < 0.0 && max(max(high.x, high.y), max(high.z, high.w)) >= 0.0;
}

void level_corners(int i, ivec3 cell, out vec4 lo, out vec4 hi) {
  cell_corners(i, cell, lo, hi);
  lo -= frame.grids[i].level;
  hi -= frame.grids[i].level;
}

#ifdef SURFACE_CELLS
layout(binding = 1) uniform utexture3D cell_map;
uint block_word(int i, ivec3 cell) {
  if (grid_is_cubic(i)) return brick_word(i, cell >> 1);  // the map of a cubic grid is the map of its cells
  return texelFetch(cell_map, cell >> 1, 0).r;
}
#else
const uint HAS_CELLS = 0;
uint block_word(int i, ivec3 cell) { return brick_word(i, cell >> 1); }
#endif

// Advances to the next cell that contains the level, by the cell map (render/residency/cell_map.h).
bool next_cell_in_map(int i, inout CellTraversal traversal, FlippedRay flipped, float to) {
  bool found = false;
  while (!found && traversal.t < to) {
    const ivec3 cell = traversal.cell ^ flipped.turned, odd = cell & 1;
    const uint block = block_word(i, cell);
    found = (block >> (odd.x + 2 * odd.y + 4 * odd.z) & 1u) != 0u;
    if (!found) {
      // skips the bricks without such cells, else the block without, else the cell
      const int distance = int(block >> 8);
      const int block_mask = distance > 0 ? 3 : (block & 255u) == 0u ? 1 : 0;
      advance_past(traversal, flipped, (traversal.cell | block_mask) + (distance > 0 ? 4 * distance - 3 : 1));
    }
  }
  return found;
}

// Advances to the next cell that contains the level, by the brick map and the cells' corners.
bool next_cell_by_corners(int i, inout CellTraversal traversal, FlippedRay flipped, float to) {
  bool found = false;
  while (!found && traversal.t < to) {
    const ivec3 cell = traversal.cell ^ flipped.turned;
    const int distance = empty_distance(brick_word(i, cell >> 3));
    if (distance == 0) {
      vec4 lo, hi;
      level_corners(i, cell, lo, hi);
      found = holds_level(lo, hi) && cell_is_valid(i, cell);
    }
    if (!found) advance_past(traversal, flipped, distance > 0 ? (traversal.cell | 7) + (8 * distance - 7) : traversal.cell + 1);
  }
  return found;
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

#ifndef NO_CUBIC
#include "shaders/lib/cubic_surface.glsl"
#endif

// Returns the first depth in [from, to] at which the ray crosses the level of grid i; NO_DEPTH: none. The inner loop advances to the next
// cell with corners on both sides, the outer one brackets a root of its cubic, and the root is solved after the loops: a driver that
// executes both sides of every branch then does not execute a later stage inside an earlier one.
float first_crossing(int i, LocalRay ray, float from, float to) {
  const FlippedRay flipped = make_flipped_ray(i, ray);
  CellTraversal traversal = CellTraversal(cell_of(i, ray.origin + from * ray.direction) ^ flipped.turned, from, bvec3(false));
#ifndef NO_CUBIC
  if (grid_is_cubic(i)) return first_cubic_crossing(i, traversal, flipped, to);
#endif
  bool found = false;
  vec4 cubic = vec4(0.0);
  Bracket bracket = Bracket(0.0, 0.0, 0.0, 1.0);
  vec2 depths = vec2(from);
  while (!found && traversal.t < to) {
    if (HAS_CELLS != 0u ? next_cell_in_map(i, traversal, flipped, to) : next_cell_by_corners(i, traversal, flipped, to)) {
      vec4 lo, hi;
      level_corners(i, traversal.cell ^ flipped.turned, lo, hi);
      const RaySegment segment = segment_in_cell(traversal, flipped, to);
      cubic = cell_cubic(lo, hi, segment.a, segment.b);
      found = first_bracket(cubic, bracket);
      depths = vec2(segment.from, segment.to);
      advance_past(traversal, flipped, traversal.cell + 1);
    }
  }
  return found ? mix(depths.x, depths.y, find_root(cubic, bracket)) : NO_DEPTH;
}
