#include "haptics/constraints/rules/surface_side.h"

#include <limits>

#include "engine/schema/values.h"
#include "haptics/constraints/rules/link_keys.h"

namespace catena::haptics {
namespace {

constexpr double kInFront = 1e-11;  // of L: round-off of a probe in front of what holds it

bool is_free(const SideRules& rules, double value) {
  return rules.free == FreeSide::above ? value >= 0 : rules.free == FreeSide::below ? value <= 0 : false;
}

/// How far the probe is in front of the sheet held, on its free side.
double in_front(const Surface& surface, const SideRules& rules, const Vec3& probe, const Vec3& proxy) {
  const double above = dot(surface.normal(), probe - proxy);
  return rules.free == FreeSide::above ? above : -above;
}

/// Whether a hand may have made the last step.
bool is_thrown(const Surface& surface, const Vec3& probe, const SideMemory& memory, const LinkState& state) {
  return memory.fresh && norm(probe - memory.probe) > std::max(kLongStep * surface.domain_length(), state.hand_step);
}

/// Passes the probe through where the field is not finite.
void leave_broken(const Vec3& probe, LinkState& state) {
  state.proxy = probe;
  state.residual = 0;
  stop_link(state, Status::critical, Reason::not_finite);
}

void leave(const Vec3& proxy, double residual, Status status, LinkState& state, Reason reason = Reason::none) {
  state.proxy = proxy;
  state.residual = residual;
  stop_link(state, status, reason);
}

void remember(const Vec3& probe, const SideValue& side, SideMemory& memory, const LinkState& state) {
  memory.probe = probe;
  memory.proxy = state.proxy;
  memory.value = side.value;
  memory.known = side.known;
  memory.residual = state.residual;
  memory.status = state.status;
  memory.reason = state.reason;
  memory.fresh = true;
  memory.settled = state.status != Status::budget;
}

/// Puts the proxy on what was found, lets go if that is too far, passes the probe through if nothing was.
void take(const Hold& hold, const SideRules& rules, const Vec3& probe, SideMemory& memory, LinkState& state) {
  if (!hold.found || !is_finite(hold.proxy)) {
    memory.holding = memory.sheet = false;
    if (hold.found)
      leave_broken(probe, state);
    else
      leave(probe, 0, hold.status == Status::budget ? Status::budget : Status::no_surface, state);
    return;
  }
  if (rules.release > 0 && norm(probe - hold.proxy) >= rules.release) {
    memory.holding = memory.sheet = false;
    state.released = true;
    leave(probe, 0, Status::released, state);
    return;
  }
  memory.holding = true;
  leave(hold.proxy, hold.residual, hold.status, state, hold.reason);
}

/// One step of the way to the probe from a sheet that holds no more. True: it is there.
bool glide(const SideRules& rules, const Vec3& probe, SideMemory& memory, LinkState& state) {
  const Vec3 way = probe - memory.proxy;
  const double far = norm(way), travel = travel_of(memory, probe, far, state);
  memory.holding = memory.sheet = false;
  memory.gliding = far > travel && !(rules.release > 0 && far >= rules.release);
  if (!(far > travel)) return true;
  if (memory.gliding) {
    leave(memory.proxy + way * (travel / far), 0, Status::budget, state);
  } else {
    state.released = true;
    leave(probe, 0, Status::released, state);
  }
  return false;
}

/// A one-sided probe on the free side, or where nothing is known of the side: what holds it there, if anything. Held before, the sheet by
/// which it came in; else one that its last step passed through.
Hold hold_beyond(Surface& surface, const SideRules& rules, const Vec3& probe, const SideMemory& memory, const LinkState& state) {
  if (is_thrown(surface, probe, memory, state)) return {};
  Hold hold;
  if (memory.holding) {
    hold = surface.slide(probe);
  } else if (surface.may_be_thin() && memory.fresh && memory.known && memory.status == Status::free) {
    hold = surface.cross(memory.probe, probe);
  }
  const bool on_its_way = memory.holding && hold.status == Status::budget;
  if (hold.found && !on_its_way && in_front(surface, rules, probe, hold.proxy) >= -kInFront * surface.domain_length()) return {};
  return hold;
}

}  // namespace

double travel_of(const SideMemory& memory, const Vec3& probe, double gap, const LinkState& state) noexcept {
  return memory.fresh ? state.travel(norm(probe - memory.probe), gap) : std::numeric_limits<double>::infinity();
}

Result<SideSpec> read_side_rules(const json::Node& link, bool has_sides, const BuildContext& context) {
  SideSpec spec;
  if (has_sides) CATENA_CHECK(schema::read_value(free_key(""), link, spec.free));
  if (link.find("snap") != nullptr) return spec;  // snap.h lets go
  CATENA_TRY(spec.release, get_parameter(link, "release", 0.0, json::Range::positive, context));
  return spec;
}

void start_on(Surface& surface, const SideRules& rules, const Vec3& probe, SideMemory& memory, LinkState& state) noexcept {
  memory = SideMemory{};
  state.released = false;
  SideValue side;
  leave(probe, 0, Status::free, state);
  if (rules.free != FreeSide::none) {
    side = surface.side(probe);
    if (!side.known || is_free(rules, side.value)) return;
  }
  const Hold hold = surface.place(probe);
  if (!hold.found && hold.status == Status::budget) state.status = Status::budget;
  if (!hold.found || !is_finite(hold.proxy)) return;
  if (rules.free != FreeSide::none && rules.release > 0 && norm(probe - hold.proxy) > rules.release) {
    state.released = true;
    return;
  }
  memory.holding = true;
  leave(hold.proxy, hold.residual, hold.status, state, hold.reason);
}

void advance_on(Surface& surface, const SideRules& rules, const Vec3& probe, SideMemory& memory, LinkState& state) noexcept {
  state.limit = rules.release;
  // a resting probe, or a proxy that somebody else has moved meanwhile
  const bool untouched = !memory.fresh || same_bits(memory.proxy, state.proxy);
  if (memory.fresh && untouched && memory.settled && same_bits(memory.probe, probe)) {
    leave(memory.proxy, memory.residual, memory.status, state, memory.reason);
    return;
  }
  if (!untouched) {
    const bool released = state.released;
    memory = SideMemory{};
    state.released = released;
  }

  // on which side, and does a released link take hold again
  const bool one_sided = rules.free != FreeSide::none;
  SideValue side;
  if (one_sided || state.released) side = surface.side(probe);
  const bool free = one_sided && side.known && is_free(rules, side.value);
  Hold hold;
  bool have_hold = false;
  if (state.released) {
    if (!one_sided) {
      const bool both = memory.fresh && memory.known && side.known;
      const bool crossed = both && (memory.value < 0) != (side.value < 0);
      if (crossed || (both && surface.may_be_thin())) hold = surface.cross(memory.probe, probe);
      if (!hold.found) hold = surface.near_by(probe, kRearmPart * rules.release);
      have_hold = hold.found;
    }
    if (!free && !have_hold) {
      leave(probe, 0, Status::released, state);
      remember(probe, side, memory, state);
      return;
    }
    state.released = memory.holding = memory.sheet = false;
  }

  if (memory.gliding && !glide(rules, probe, memory, state)) return remember(probe, side, memory, state);

  // on the free side: free, or beyond a body that holds
  if (free) {
    hold = hold_beyond(surface, rules, probe, memory, state);
    if (!hold.found) {
      if (memory.holding && !glide(rules, probe, memory, state)) return remember(probe, side, memory, state);
      memory.holding = memory.sheet = false;
      leave(probe, 0, Status::free, state);
      remember(probe, side, memory, state);
      return;
    }
    have_hold = true;
  }
  memory.sheet = free;

  // nothing is known of the side here: what is held stays held, what is free stays free unless the step went through a sheet
  if (one_sided && !side.known && !memory.holding) {
    hold = hold_beyond(surface, rules, probe, memory, state);
    if (!hold.found) {
      if (side.broken)
        leave_broken(probe, state);
      else
        leave(probe, 0, Status::free, state);
      remember(probe, side, memory, state);
      return;
    }
    have_hold = true;
  }

  // hold
  if (!have_hold) {
    if (memory.holding) {
      hold = surface.slide(probe);
    } else {
      if (one_sided && memory.fresh) hold = surface.cross(memory.probe, probe);
      if (!hold.found) hold = surface.place(probe);
    }
  }
  take(hold, rules, probe, memory, state);
  if (state.released && !side.known) side = surface.side(probe);
  remember(probe, side, memory, state);
}

}  // namespace catena::haptics
