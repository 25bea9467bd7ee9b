#include "engine/base/numbers.h"
#include "engine/flow/curve.h"
#include "engine/flow/march.h"

namespace catena::flow {

namespace {

std::string triple(const Vec3& v) { return "(" + to_text(v.x) + ", " + to_text(v.y) + ", " + to_text(v.z) + ")"; }

std::string domain_text(const field::Field& field) {
  const Bounds box = field.world_bounds();
  return triple(box.lo) + " to " + triple(box.hi);
}

Error no_direction(const Flow& flow, const Vec3& seed, Stop stop) {
  const std::string name = flow.field->name().empty() ? "the field" : "field '" + flow.field->name() + "'";
  if (stop == Stop::outside)
    return Error{"seed " + triple(seed) + " lies outside the domain of " + name + " (its box goes from " + domain_text(*flow.field) +
                 "; masked and non-finite cells do not count)"};
  if (stop == Stop::incoherent)
    return Error{"seed " + triple(seed) + ": the axes of the line field " + name + " disagree there, so no single line passes through it"};
  if (flow.min_speed > 0)
    return Error{"seed " + triple(seed) + ": the speed of " + name + " is not above min_speed " + to_text(flow.min_speed) + " there"};
  return Error{"seed " + triple(seed) + ": " + name + " is zero there, so no line passes through it"};
}

template <class Medium>
Result<Vec3> tangent_in(Medium medium, const Flow& flow, const Vec3& seed) {
  Vec3 u;
  if (const Stop stop = medium.seed(seed, u); stop != Stop::none) return no_direction(flow, seed, stop);
  return u;
}

template <class Medium>
Branch march_in(Medium medium, const Flow& flow, const Vec3& place, double sign, const TraceOptions& options) {
  Vec3 u;
  const Stop stop = medium.seed(place, u);
  if (stop != Stop::none) return {{}, line_end(stop, medium.outside())};
  return March<Medium>(medium, flow, options).run(place, u, sign);
}

template <class Medium>
Result<CurvePtr> trace_in(Medium medium, const Flow& flow, const Vec3& seed, const TraceOptions& options) {
  CATENA_TRY(const Vec3 u, tangent_in(medium, flow, seed));
  // forward, and backward unless it came round
  Branch forward = March<Medium>(medium, flow, options).run(seed, u, 1);
  Branch backward;
  if (forward.end.end != End::lap) backward = March<Medium>(medium, flow, options).run(seed, u, -1);
  return sewn(flow, seed, forward, backward);
}

}  // namespace

Result<Vec3> seed_tangent(const Flow& flow, const Vec3& seed) {
  if (!is_finite(seed)) return Error{"seed " + triple(seed) + " is not finite; three finite numbers were expected"};
  return flow.field->grid() ? tangent_in(CellMedium(flow), flow, seed) : tangent_in(FormulaMedium(flow), flow, seed);
}

Branch march_from(const Flow& flow, const Vec3& place, double sign, const TraceOptions& options) {
  return flow.field->grid() ? march_in(CellMedium(flow), flow, place, sign, options)
                            : march_in(FormulaMedium(flow), flow, place, sign, options);
}

Result<CurvePtr> sewn(const Flow& flow, const Vec3& seed, const Branch& forward, const Branch& backward) {
  const double domain = flow.field->length();
  if (forward.end.end == End::lap) return CurvePtr(std::make_shared<const Curve>(forward.knots, true, forward.end, forward.end, domain));
  std::vector<Knot> knots;
  knots.reserve(backward.knots.size() + forward.knots.size());
  knots.assign(backward.knots.rbegin(), backward.knots.rend());
  knots.insert(knots.end(), forward.knots.begin() + 1, forward.knots.end());
  if (knots.size() < 2) return Error{"seed " + triple(seed) + ": the line ends on the spot in both directions"};
  return CurvePtr(std::make_shared<const Curve>(std::move(knots), false, backward.end, forward.end, domain));
}

TraceOptions filled_options(const Flow& flow, TraceOptions options) {
  if (!(options.length > 0)) options.length = 10 * flow.field->length();
  options.max_knots = std::max<std::size_t>(options.max_knots / 2, 8);
  return options;
}

Result<CurvePtr> trace(const Flow& flow, const Vec3& seed, const TraceOptions& options) {
  if (!is_finite(seed)) return Error{"seed " + triple(seed) + " is not finite; three finite numbers were expected"};
  const TraceOptions filled = filled_options(flow, options);
  return flow.field->grid() ? trace_in(CellMedium(flow), flow, seed, filled) : trace_in(FormulaMedium(flow), flow, seed, filled);
}

}  // namespace catena::flow
