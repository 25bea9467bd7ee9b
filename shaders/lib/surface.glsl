// The first crossing of a level along a ray. In a trilinear cell the value along the ray is a cubic; its Bernstein coefficients
// come exactly from the polar form of the trilinear function (a and b: entry and exit within the cell, F the blossom):
//   B0 = F(a,a,a)   B1 = (F(b,a,a) + F(a,b,a) + F(a,a,b)) / 3   B2 = (F(a,b,b) + F(b,a,b) + F(b,b,a)) / 3   B3 = F(b,b,b)
// All of one sign: no root. Else the cubic is cut at its extrema and the first monotonic piece that changes sign is bracketed.

vec4 cell_cubic(vec4 lo, vec4 hi, vec3 a, vec3 b) {
  const vec4 za = mix(lo, hi, a.z), zb = mix(lo, hi, b.z);
  const vec2 ya_za = mix(za.xy, za.zw, a.y), yb_za = mix(za.xy, za.zw, b.y);
  const vec2 ya_zb = mix(zb.xy, zb.zw, a.y), yb_zb = mix(zb.xy, zb.zw, b.y);
  const float aaa = mix(ya_za.x, ya_za.y, a.x), baa = mix(ya_za.x, ya_za.y, b.x);
  const float aba = mix(yb_za.x, yb_za.y, a.x), bba = mix(yb_za.x, yb_za.y, b.x);
  const float aab = mix(ya_zb.x, ya_zb.y, a.x), bab = mix(ya_zb.x, ya_zb.y, b.x);
  const float abb = mix(yb_zb.x, yb_zb.y, a.x), bbb = mix(yb_zb.x, yb_zb.y, b.x);
  return vec4(aaa, (baa + aba + aab) / 3.0, (abb + bab + bba) / 3.0, bbb);
}

float cubic_at(vec4 c, float u) {
  const vec3 p = mix(c.xyz, c.yzw, u);
  const vec2 q = mix(p.xy, p.yz, u);
  return mix(q.x, q.y, u);
}

// The root of a monotonic piece with a change of sign: false position (Illinois), kept in its bracket.
float bracketed_root(vec4 c, float a, float b, float fa, float fb) {
  float u = a;
  for (int i = 0; i < 24; ++i) {
    const float span = fb - fa;
    u = abs(span) > 0.0 ? clamp(a - fa * (b - a) / span, a, b) : 0.5 * (a + b);
    const float f = cubic_at(c, u);
    if (f == 0.0 || b - a < 1e-7) break;
    if ((f >= 0.0) == (fb >= 0.0)) {
      b = u;
      fb = f;
      fa *= 0.5;
    } else {
      const float old = fb;
      a = u;
      fa = f;
      fb = old * 0.5;
    }
  }
  return u;
}

// The least root in 0..1; negative if there is none.
float first_root(vec4 c) {
  if ((c.x >= 0.0 && c.y >= 0.0 && c.z >= 0.0 && c.w >= 0.0) || (c.x < 0.0 && c.y < 0.0 && c.z < 0.0 && c.w < 0.0)) return -1.0;
  // extrema: roots of the derivative, a quadratic with the Bernstein coefficients d
  const vec3 d = c.yzw - c.xyz;
  const float qa = d.x - 2.0 * d.y + d.z, qb = d.y - d.x, qc = d.x;
  vec2 cut = vec2(1.0);
  const float discriminant = qb * qb - qa * qc;
  if (discriminant > 0.0) {
    const float w = -(qb + (qb >= 0.0 ? 1.0 : -1.0) * sqrt(discriminant));
    const float r0 = abs(qa) > 0.0 ? w / qa : 1.0, r1 = abs(w) > 0.0 ? qc / w : 1.0;
    cut = clamp(vec2(min(r0, r1), max(r0, r1)), 0.0, 1.0);
  }
  const float f0 = c.x, f1 = cubic_at(c, cut.x), f2 = cubic_at(c, cut.y), f3 = c.w;
  if ((f0 >= 0.0) != (f1 >= 0.0)) return bracketed_root(c, 0.0, cut.x, f0, f1);
  if ((f1 >= 0.0) != (f2 >= 0.0)) return bracketed_root(c, cut.x, cut.y, f1, f2);
  if ((f2 >= 0.0) != (f3 >= 0.0)) return bracketed_root(c, cut.y, 1.0, f2, f3);
  return -1.0;
}

// A walk along a ray through the cells of a grid.
struct Walk {
  ivec3 cell;
  float t, leave;  // depths at which the ray enters and leaves the cell
  int side;        // of the level, where the last cell was left: 1, -1; 0 unknown
  bool done;
  vec4 lo, hi;     // the corners, less the level
};

void leave_cell(inout Walk walk, LocalRay ray, vec3 inverse, bvec3 forward, ivec3 first, ivec3 last) {
  const vec3 leave = (mix(vec3(walk.cell), vec3(walk.cell + 1), forward) - ray.origin) * inverse;
  const ivec3 towards = ivec3(mix(vec3(-1.0), vec3(1.0), forward));
  const bool x = leave.x <= min(leave.y, leave.z), y = !x && leave.y <= leave.z;
  walk.cell += ivec3(x ? towards.x : 0, y ? towards.y : 0, x || y ? 0 : towards.z);
  walk.t = walk.leave;
  walk.done = any(lessThan(walk.cell, first)) || any(greaterThan(walk.cell, last));
}

// Leaps to where the ray leaves the empty bricks around the walk's cell.
void leave_bricks(inout Walk walk, LocalRay ray, vec3 inverse, bvec3 forward, ivec3 first, ivec3 last, int distance) {
  const ivec3 brick = walk.cell >> 3;
  const ivec3 lo = (brick - (distance - 1)) * BRICK, hi = (brick + distance) * BRICK;
  const vec3 leave = (mix(vec3(lo), vec3(hi), forward) - ray.origin) * inverse;
  const float out_at = min(min(leave.x, leave.y), leave.z);
  const ivec3 inside = clamp(ivec3(floor(ray.origin + out_at * ray.direction)), max(lo, first), min(hi - 1, last));
  const ivec3 beyond = ivec3(mix(vec3(lo - 1), vec3(hi), forward));
  const bool x = leave.x == out_at, y = !x && leave.y == out_at;
  walk.cell = ivec3(x ? beyond.x : inside.x, y ? beyond.y : inside.y, x || y ? inside.z : beyond.z);
  walk.t = max(walk.t, out_at);
  walk.side = 0;
  walk.done = any(lessThan(walk.cell, first)) || any(greaterThan(walk.cell, last));
}

// The first depth in [from, to] at which the ray crosses the level of grid i; NO_DEPTH if there is none. An inner loop walks to
// the next cell whose corners lie on both sides, the outer one solves its cubic: on a driver that executes both sides of every
// branch this keeps the solver out of the walk.
float first_crossing(int i, LocalRay ray, float from, float to) {
  const float level = frame.grids[i].level;
  const ivec3 first = ivec3(frame.grids[i].lo), last = ivec3(frame.grids[i].hi) - 1;
  const vec3 inverse = safe_inverse(ray.direction);
  const bvec3 forward = forward_of(ray.direction);
  Walk walk;
  walk.cell = cell_of(i, ray.origin + from * ray.direction);
  walk.t = walk.leave = from;
  walk.side = 0;
  walk.done = false;
  float found = NO_DEPTH;
  while (found == NO_DEPTH && !walk.done && walk.t < to) {
    bool candidate = false;
    while (!candidate && !walk.done && walk.t < to) {
      const int distance = empty_distance(brick_word(i, walk.cell >> 3));
      if (distance > 0) {
        leave_bricks(walk, ray, inverse, forward, first, last, distance);
      } else {
        const vec3 leave = (mix(vec3(walk.cell), vec3(walk.cell + 1), forward) - ray.origin) * inverse;
        walk.leave = clamp(min(min(leave.x, leave.y), leave.z), walk.t, to);
        cell_corners(i, walk.cell, walk.lo, walk.hi);
        walk.lo -= level;
        walk.hi -= level;
        const vec4 low = min(walk.lo, walk.hi), high = max(walk.lo, walk.hi);
        const bool above = min(min(low.x, low.y), min(low.z, low.w)) >= 0.0, below = max(max(high.x, high.y), max(high.z, high.w)) < 0.0;
        const int here = above ? 1 : below ? -1 : 0;
        bool valid = true;
        if (grid_is_masked(i)) valid = cell_is_valid(i, walk.cell);
        // also where rounding at a face hid the change of sign
        candidate = valid && (here == 0 || here == -walk.side);
        if (!candidate) {
          walk.side = valid ? here : 0;
          leave_cell(walk, ray, inverse, forward, first, last);
        }
      }
    }
    if (candidate) {
      const vec3 a = clamp(ray.origin + walk.t * ray.direction - vec3(walk.cell), 0.0, 1.0);
      const vec3 b = clamp(ray.origin + walk.leave * ray.direction - vec3(walk.cell), 0.0, 1.0);
      const vec4 c = cell_cubic(walk.lo, walk.hi, a, b);
      const int entered = c.x >= 0.0 ? 1 : -1;
      if (walk.side == -entered) {
        found = walk.t;
      } else {
        const float u = first_root(c);
        if (u >= 0.0) found = mix(walk.t, walk.leave, u);
        walk.side = c.w >= 0.0 ? 1 : -1;
        leave_cell(walk, ray, inverse, forward, first, last);
      }
    }
  }
  return found;
}
