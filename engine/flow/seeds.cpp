#include "engine/flow/seeds.h"

#include <cmath>
#include <numbers>

#include "engine/flow/root.h"

namespace catena::flow {

namespace {

constexpr double kPi = std::numbers::pi;
const double kGoldenAngle = kPi * (3 - std::sqrt(5.0));

double share(int i, int count) { return count > 1 ? static_cast<double>(i) / (count - 1) : 0.5; }

double fraction(double x) { return x - std::floor(x); }

Vec3 on_unit_sphere(double a, double b) {
  const double z = 2 * a - 1, r = std::sqrt(std::max(0.0, 1 - z * z)), angle = 2 * kPi * b;
  return {r * std::cos(angle), r * std::sin(angle), z};
}

/// The part of a line (0..1 between its ends) within the box of the domain, index coordinates.
bool clip(const field::Box& box, const Vec3& from, const Vec3& to, double& first, double& last) {
  first = 0;
  last = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double way = to[axis] - from[axis];
    if (way == 0) {
      if (from[axis] < box.lo[axis] || from[axis] > box.hi[axis]) return false;
      continue;
    }
    double a = (box.lo[axis] - from[axis]) / way, b = (box.hi[axis] - from[axis]) / way;
    if (a > b) std::swap(a, b);
    first = std::max(first, a);
    last = std::min(last, b);
  }
  return first < last;
}

}  // namespace

std::vector<Vec3> seeds_on_line(const Vec3& from, const Vec3& to, int count) {
  std::vector<Vec3> seeds;
  for (int i = 0; i < count; ++i) {
    const double t = share(i, count);
    seeds.push_back((1 - t) * from + t * to);
  }
  return seeds;
}

std::vector<Vec3> seeds_on_plane(const Vec3& origin, const Vec3& u, const Vec3& v, int count_u, int count_v) {
  std::vector<Vec3> seeds;
  for (int j = 0; j < count_v; ++j)
    for (int i = 0; i < count_u; ++i) seeds.push_back(origin + share(i, count_u) * u + share(j, count_v) * v);
  return seeds;
}

std::vector<Vec3> seeds_on_sphere(const Vec3& centre, double radius, int count, bool inside) {
  std::vector<Vec3> seeds;
  for (int i = 0; i < count; ++i) {
    const double at = (i + 0.5) / count;
    // within the ball the radius must not rise with the height: another irrational number orders it
    const double r = inside ? radius * std::cbrt(fraction(0.5 + i * 0.7548776662466927)) : radius;
    seeds.push_back(centre + r * on_unit_sphere(at, fraction(i * kGoldenAngle / (2 * kPi))));
  }
  return seeds;
}

std::vector<Vec3> seeds_on_isosurface(const field::ScalarField& field, double level, int count) {
  // the sphere about the domain
  const field::Box& box = field.index_box();
  const field::Mapping& mapping = field.mapping();
  const Vec3 centre = mapping.world_from_index(0.5 * (box.lo + box.hi));
  double radius = 0;
  for (int c = 0; c < 8; ++c) radius = std::max(radius, norm(field.corner(c) - centre));
  const double step = field.is_grid() ? 0.5 * mapping.smallest_edge() : field.length() / 128;

  std::vector<Vec3> seeds;
  field::Cursor cursor;
  const long most_lines = std::max(4096L, 64L * count);
  for (long n = 1; n <= most_lines && static_cast<int>(seeds.size()) < count; ++n) {
    const double turn = static_cast<double>(n);
    const Vec3 from = centre + radius * on_unit_sphere(fraction(turn * 0.8566748838545029), fraction(turn * 0.7338918566271260));
    const Vec3 to = centre + radius * on_unit_sphere(fraction(turn * 0.6287067210378087), fraction(turn * 0.5385972572236101));
    double first, last;
    if (!clip(box, mapping.index_from_world(from), mapping.index_from_world(to), first, last)) continue;
    const int steps = std::max(1, static_cast<int>(std::ceil((last - first) * norm(to - from) / step)));
    const auto place = [&](double t) { return (1 - t) * from + t * to; };
    double t_before = first;
    field::ScalarSample before = field.sample(place(first), cursor);
    for (int i = 1; i <= steps && static_cast<int>(seeds.size()) < count; ++i) {
      const double t = first + (last - first) * i / steps;
      const field::ScalarSample here = field.sample(place(t), cursor);
      const double a = before.value - level, b = here.value - level;
      if (before.inside && here.inside && std::isfinite(a) && std::isfinite(b) && (a < 0) != (b < 0))
        seeds.push_back(place(illinois_root(t_before, a, t, b, [&](double at) { return field.sample(place(at), cursor).value - level; })));
      before = here;
      t_before = t;
    }
  }
  return seeds;
}

}  // namespace catena::flow
