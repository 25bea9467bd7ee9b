#include "haptics/chain/baseline.h"

namespace catena::haptics {

namespace {

constexpr double kParallel = 1e-7;  // sine of the least angle at which two equations count as two

/// An orthonormal pair across the unit vector n.
void across_pair(const Vec3& n, Vec3& a, Vec3& b) noexcept {
  const Vec3 pick = std::fabs(n.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  a = direction(cross(n, pick));
  b = cross(n, a);
}

}  // namespace

void Span::add(const Vec3& normal, double distance) noexcept {
  // the part of the equation that those before it do not fix (twice: as good as orthogonal)
  Vec3 n = normal;
  double d = distance;
  for (int turn = 0; turn < 2; ++turn)
    for (int k = 0; k < count_; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const double part = dot(n, rows_[i]);
      n -= part * rows_[i];
      d -= part * distances_[i];
    }
  const double r = norm(n);
  if (count_ == 3 || !(r > kParallel) || !std::isfinite(d)) return;
  rows_[static_cast<std::size_t>(count_)] = n / r;
  distances_[static_cast<std::size_t>(count_++)] = d / r;
}

void Span::add(const Primitive& primitive, const Vec3& from) noexcept {
  const Vec3 e = primitive.origin - from;
  if (primitive.kind == Primitive::Kind::plane) return add(primitive.axis, dot(primitive.axis, e));
  Vec3 a(1, 0, 0), b(0, 1, 0);
  if (primitive.kind == Primitive::Kind::line) {
    across_pair(primitive.axis, a, b);
  } else {
    add(Vec3(0, 0, 1), e.z);
  }
  add(a, dot(a, e));
  add(b, dot(b, e));
}

Vec3 Span::move() const noexcept {
  Vec3 sum(0.0);
  for (int k = 0; k < count_; ++k) sum += distances_[static_cast<std::size_t>(k)] * rows_[static_cast<std::size_t>(k)];
  return sum;
}

Vec3 Span::across(Vec3 v) const noexcept {
  if (count_ == 3) return Vec3(0.0);
  for (int turn = 0; turn < 2; ++turn)
    for (int k = 0; k < count_; ++k) v -= dot(v, rows_[static_cast<std::size_t>(k)]) * rows_[static_cast<std::size_t>(k)];
  return v;
}

double distance_to(const Primitive& primitive, const Vec3& place) noexcept {
  const Vec3 e = place - primitive.origin;
  switch (primitive.kind) {
    case Primitive::Kind::plane:
      return std::fabs(dot(primitive.axis, e));
    case Primitive::Kind::line:
      return norm(e - dot(primitive.axis, e) * primitive.axis);
    default:
      return norm(e);
  }
}

}  // namespace catena::haptics
