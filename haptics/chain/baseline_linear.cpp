/// Single proxy with linear constraints: the move x - p along what the primitives at p leave free (Eqs 1-2 for a line, Eq. 6 for
/// a plane), nothing corrected. A one-sided surface takes part while the probe is behind it; where it begins to, the proxy is
/// put on it. A move to a place without a primitive is not made.
#include "haptics/chain/baseline.h"

namespace catena::haptics {

Vec3 linear(SingleTick& tick) noexcept {
  Vec3 p = tick.single.proxy;

  // who takes part
  tick.each([&](std::size_t i) {
    LinkState& link = tick.links[i];
    if (!tick.program.links[i].one_sided) {
      tick.holds[i] = true;
      link.status = Status::ok;
      return;
    }
    tick.holds[i] = tick.apply(i, tick.probe);
    if (tick.holds[i] && !tick.single.watches[i].holds) p = link.proxy;
  });

  // the primitives at p
  Span span;
  bool any = false;
  tick.each([&](std::size_t i) {
    if (!tick.holds[i]) return;
    LinkState& link = tick.links[i];
    any = true;
    if (!tick.program.links[i].one_sided) link.proxy = p;
    Primitive primitive;
    if (tick.primitive(i, p, primitive)) {
      link.residual = distance_to(primitive, p);
    } else if (link.status == Status::no_surface) {
      tick.holds[i] = false;
      return;
    } else {
      primitive = {Primitive::Kind::point, p, Vec3(0.0)};
    }
    span.add(primitive, p);
  });
  if (!any) return tick.probe;

  // a move to where every primitive still exists
  const Vec3 next = p + span.across(tick.probe - p);
  if (!is_finite(next)) return p;
  bool stays = false;
  tick.each([&](std::size_t i) {
    if (!tick.holds[i] || stays) return;
    LinkState& link = tick.links[i];
    const LinkState before = link;
    Primitive primitive;
    if (!tick.program.links[i].one_sided) link.proxy = next;
    stays = !tick.primitive(i, next, primitive);
    const Status status = link.status;
    const std::int32_t evaluations = link.evaluations;
    link = before;
    link.evaluations = evaluations;
    if (stays) link.status = status;
  });
  return stays ? p : next;
}

}  // namespace catena::haptics
