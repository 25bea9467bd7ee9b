#include "engine/flow/curve.h"

#include <algorithm>

#include "engine/base/assert.h"
#include "engine/flow/hermite.h"

namespace catena::flow {

const char* end_word(End end) {
  switch (end) {
    case End::boundary:
      return "BOUNDARY";
    case End::critical:
      return "CRITICAL";
    case End::length:
      return "LENGTH";
    case End::lap:
      return "LAP";
    case End::incoherent:
      return "INCOHERENT";
  }
  return "LENGTH";
}

Curve::Curve(std::vector<Knot> knots, bool closed, LineEnd first_end, LineEnd last_end, double domain_length)
    : knots_(std::move(knots)), closed_(closed), first_end_(first_end), last_end_(last_end), domain_length_(domain_length) {
  CATENA_ASSERT(knots_.size() >= 2);
  for (std::size_t k = 1; k < knots_.size(); ++k) CATENA_ASSERT(knots_[k].s > knots_[k - 1].s);
}

void Curve::evaluate_in(std::size_t k, double s, Vec3& p, Vec3& derivative) const noexcept {
  const Knot &a = knots_[k], &b = knots_[k + 1];
  const double h = b.s - a.s;
  const Hermite hermite(a.p, b.p - a.p, h, a.t, b.t);
  const double theta = (s - a.s) / h;
  p = theta == 1 ? b.p : hermite.at(theta);
  derivative = theta == 1 ? b.t : hermite.derivative(theta) / h;
}

std::size_t Curve::interval_of(double s) const noexcept {
  const auto after = std::upper_bound(knots_.begin(), knots_.end(), s, [](double value, const Knot& knot) { return value < knot.s; });
  const auto index = after - knots_.begin();
  return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(index - 1, 0, static_cast<std::ptrdiff_t>(knots_.size()) - 2));
}

Vec3 Curve::position(double s) const noexcept {
  const double lo = knots_.front().s, hi = knots_.back().s;
  if (closed_ && (s < lo || s > hi)) s -= period() * std::floor((s - lo) / period());
  s = std::clamp(s, lo, hi);
  Vec3 p, derivative;
  evaluate_in(interval_of(s), s, p, derivative);
  return p;
}

}  // namespace catena::flow
