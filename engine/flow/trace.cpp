#include "engine/base/numbers.h"
#include "engine/flow/curve.h"
#include "engine/flow/march.h"

namespace catena::flow {

namespace {

std::string triple(const Vec3& v) { return "(" + to_text(v.x) + ", " + to_text(v.y) + ", " + to_text(v.z) + ")"; }

std::string domain_text(const field::Field& field) {
  const field::Box& box = field.index_box();
  const Vec3 a = field.mapping().world_from_index(box.lo), b = field.mapping().world_from_index(box.hi);
  return triple(a) + " to " + triple(b);
}

Error no_direction(const Flow& flow, const Vec3& seed, Stop stop) {
  const std::string name = flow.field->name().empty() ? "the field" : "field '" + flow.field->name() + "'";
  if (stop == Stop::outside)
    return Error{"seed " + triple(seed) + " lies outside the domain of " + name + " (its box goes from " + domain_text(*flow.field) +
                 "; masked and non-finite cells do not count)"};
  if (flow.min_speed > 0)
    return Error{"seed " + triple(seed) + ": the speed of " + name + " is not above min_speed " + to_text(flow.min_speed) + " there"};
  return Error{"seed " + triple(seed) + ": " + name + " is zero there, so no line passes through it"};
}

template <class Medium>
Result<CurvePtr> trace_in(Medium medium, const Flow& flow, const Vec3& seed, const TraceOptions& options) {
  Vec3 u;
  if (const Stop stop = medium.seed(seed, u); stop != Stop::none) return no_direction(flow, seed, stop);
  const double domain = flow.field->length();

  // forward, and backward unless it came round
  Branch forward = March<Medium>(medium, flow, options).run(seed, u, 1);
  if (forward.end == End::lap) return CurvePtr(std::make_shared<const Curve>(std::move(forward.knots), true, End::lap, End::lap, domain));
  Branch backward = March<Medium>(medium, flow, options).run(seed, u, -1);
  std::vector<Knot> knots(backward.knots.rbegin(), backward.knots.rend());
  knots.insert(knots.end(), forward.knots.begin() + 1, forward.knots.end());
  if (knots.size() < 2) return Error{"seed " + triple(seed) + ": the line ends on the spot in both directions"};
  return CurvePtr(std::make_shared<const Curve>(std::move(knots), false, backward.end, forward.end, domain));
}

}  // namespace

Result<CurvePtr> trace(const Flow& flow, const Vec3& seed, const TraceOptions& options) {
  if (!is_finite(seed)) return Error{"seed " + triple(seed) + " is not finite; three finite numbers were expected"};
  TraceOptions filled = options;
  if (!(filled.length > 0)) filled.length = 10 * flow.field->length();
  filled.max_knots = std::max<std::size_t>(filled.max_knots / 2, 8);
  return flow.field->grid() ? trace_in(CellMedium(flow), flow, seed, filled) : trace_in(FormulaMedium(flow), flow, seed, filled);
}

}  // namespace catena::flow
