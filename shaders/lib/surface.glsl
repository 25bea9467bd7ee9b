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

// The first depth in [from, to] at which the ray crosses the level of grid i; NO_DEPTH if there is none.
float first_crossing(int i, LocalRay ray, float from, float to) {
  const float level = frame.grids[i].level;
  const ivec3 first = ivec3(frame.grids[i].lo), last = ivec3(frame.grids[i].hi) - 1;
  const vec3 inverse = safe_inverse(ray.direction);
  const bvec3 forward = greaterThan(ray.direction, vec3(0.0));
  const ivec3 towards = ivec3(mix(vec3(-1.0), vec3(1.0), forward));
  const vec3 ahead = mix(vec3(0.0), vec3(1.0), forward);
  float t = from;
  ivec3 cell = cell_of(i, ray.origin + t * ray.direction);
  int side = 0;  // of the level, where the last cell was left; 0: unknown
  const ivec3 extent = last - first;
  for (int guard = 2 * (extent.x + extent.y + extent.z) + 8; guard > 0 && t < to; --guard) {
    const uint word = brick_word(i, cell >> 3);
    vec3 leave;
    if (empty_distance(word) > 0) {
      // leap over the empty bricks
      const int d = empty_distance(word);
      const ivec3 brick = cell >> 3;
      const ivec3 lo = (brick - (d - 1)) * BRICK, hi = (brick + d) * BRICK;
      leave = (mix(vec3(lo), vec3(hi), forward) - ray.origin) * inverse;
      const float out_at = min(min(leave.x, leave.y), leave.z);
      const ivec3 next = clamp(ivec3(floor(ray.origin + out_at * ray.direction)), max(lo, first), min(hi - 1, last));
      cell = next;
      if (leave.x == out_at) cell.x = forward.x ? hi.x : lo.x - 1;
      else if (leave.y == out_at) cell.y = forward.y ? hi.y : lo.y - 1;
      else cell.z = forward.z ? hi.z : lo.z - 1;
      t = max(t, out_at);
      side = 0;
    } else {
      leave = (vec3(cell) + ahead - ray.origin) * inverse;
      const float out_at = clamp(min(min(leave.x, leave.y), leave.z), t, to);
      if (cell_is_valid(i, cell)) {
        vec4 lo, hi;
        cell_corners(i, cell, lo, hi);
        lo -= level;
        hi -= level;
        const vec4 low = min(lo, hi), high = max(lo, hi);
        const float least = min(min(low.x, low.y), min(low.z, low.w)), greatest = max(max(high.x, high.y), max(high.z, high.w));
        if (least < 0.0 && greatest >= 0.0) {
          const vec3 a = clamp(ray.origin + t * ray.direction - vec3(cell), 0.0, 1.0);
          const vec3 b = clamp(ray.origin + out_at * ray.direction - vec3(cell), 0.0, 1.0);
          const vec4 c = cell_cubic(lo, hi, a, b);
          // rounding at a face must not open a gap
          if (side != 0 && side != (c.x >= 0.0 ? 1 : -1)) return t;
          const float u = first_root(c);
          if (u >= 0.0) return mix(t, out_at, u);
          side = c.w >= 0.0 ? 1 : -1;
        } else {
          const int here = least >= 0.0 ? 1 : -1;
          if (side != 0 && side != here) return t;
          side = here;
        }
      } else {
        side = 0;
      }
      if (leave.x <= min(leave.y, leave.z)) cell.x += towards.x;
      else if (leave.y <= leave.z) cell.y += towards.y;
      else cell.z += towards.z;
      t = out_at;
    }
    if (any(lessThan(cell, first)) || any(greaterThan(cell, last))) return NO_DEPTH;
  }
  return NO_DEPTH;
}
