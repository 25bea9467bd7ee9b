// SPDX-License-Identifier: MIT
// First crossing of a level along a ray in a cell. In a trilinear cell the value along the ray is a cubic; its Bernstein coefficients are exact values of the polar form (blossom) F of the trilinear function, with a and b the entry and
// exit in the cell:
//   B0 = F(a,a,a)   B1 = (F(b,a,a) + F(a,b,a) + F(a,a,b)) / 3   B2 = (F(a,b,b) + F(b,a,b) + F(b,b,a)) / 3   B3 = F(b,b,b)
// If all have one sign, there is no root. Else the cubic is split at its extrema, and the first monotonic piece with a change of sign is
// bracketed. Watertight: the value at a face is equal in both cells (the coordinate across the face is exactly 0 or 1, and `precise`
// forbids contraction), so that no change of sign is lost between them. A cell whose corners lie on one side of the level is skipped.
#include "shaders/lib/cell_traversal.glsl"

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

bool holds_level(vec4 lo, vec4 hi) {
  const vec4 low = min(lo, hi), high = max(lo, hi);
  return min(min(low.x, low.y), min(low.z, low.w)) < 0.0 && max(max(high.x, high.y), max(high.z, high.w)) >= 0.0;
}
