// SPDX-License-Identifier: MIT
#include "haptics/constraints/common/one_sided_contact.h"

#include <limits>

#include "engine/schema/values.h"
#include "haptics/constraints/common/link_schema.h"

namespace catena::haptics {
namespace {

constexpr double kInFront = 1e-11;  // fraction of L; round-off allowance for a probe in front of the sheet that holds the proxy

bool is_free(const SideRules& rules, double value) {
  return rules.free == FreeSide::above ? value >= 0 : rules.free == FreeSide::below ? value <= 0 : false;
}

/// Returns the signed distance of the probe from the held sheet, positive on its free side.
double in_front(const ContactSurface& surface, const SideRules& rules, const Vec3& probe, const Vec3& proxy) {
  const double above = dot(surface.normal(), probe - proxy);
  return rules.free == FreeSide::above ? above : -above;
}

/// Returns whether the last probe step is too long for a user's motion (a teleport; see kMaxProbeSpeed).
bool is_thrown(const ContactSurface& surface, const Vec3& probe, const SideMemory& memory, const LinkState& state) {
  return memory.initialized && norm(probe - memory.probe) > std::max(kLongStepFraction * surface.domain_length(), state.max_probe_step);
}

/// Passes the probe through where the field is not finite.
void leave_broken(const Vec3& probe, LinkState& state) {
  state.proxy = probe;
  state.residual = 0;
  set_link_status(state, LinkStatus::critical, SampleStatus::not_finite);
}

void leave(const Vec3& proxy, double residual, LinkStatus status, LinkState& state, SampleStatus reason = SampleStatus::ok) {
  state.proxy = proxy;
  state.residual = residual;
  set_link_status(state, status, reason);
}

void remember(const Vec3& probe, const SideValue& side, SideMemory& memory, const LinkState& state) {
  memory.probe = probe;
  memory.proxy = state.proxy;
  memory.value = side.value;
  memory.has_value = side.is_known;
  memory.residual = state.residual;
  memory.status = state.status;
  memory.reason = state.reason;
  memory.initialized = true;
  memory.settled = state.status != LinkStatus::budget;
}

/// Moves the proxy to the point found; releases the link if that is too far from the probe; passes the probe through if nothing was found.
void take(const SurfaceHold& hold, const SideRules& rules, const Vec3& probe, SideMemory& memory, LinkState& state) {
  if (!hold.found || !is_finite(hold.proxy)) {
    memory.holding = memory.beyond_body = false;
    if (hold.found)
      leave_broken(probe, state);
    else
      leave(probe, 0, hold.status == LinkStatus::budget ? LinkStatus::budget : LinkStatus::no_surface, state);
    return;
  }
  if (rules.release > 0 && norm(probe - hold.proxy) >= rules.release) {
    memory.holding = memory.beyond_body = false;
    state.released = true;
    leave(probe, 0, LinkStatus::released, state);
    return;
  }
  memory.holding = true;
  leave(hold.proxy, hold.residual, hold.status, state, hold.reason);
}

/// Moves the proxy one step toward the probe, from a sheet that no longer holds it. Returns true if it reaches the probe.
bool glide(const SideRules& rules, const Vec3& probe, SideMemory& memory, LinkState& state) {
  const Vec3 way = probe - memory.proxy;
  const double far = norm(way), travel = max_proxy_travel(memory, probe, far, state);
  memory.holding = memory.beyond_body = false;
  memory.gliding = far > travel && !(rules.release > 0 && far >= rules.release);
  if (!(far > travel)) return true;
  if (memory.gliding) {
    leave(memory.proxy + way * (travel / far), 0, LinkStatus::budget, state);
  } else {
    state.released = true;
    leave(probe, 0, LinkStatus::released, state);
  }
  return false;
}

/// Returns the sheet that still holds the proxy of a one-sided link whose probe is on the free side or on an unknown side. If the link was
/// in contact, that is the sheet through which the probe entered; otherwise a sheet that the last probe step crossed.
SurfaceHold hold_beyond(ContactSurface& surface, const SideRules& rules, const Vec3& probe, const SideMemory& memory,
                        const LinkState& state) {
  if (is_thrown(surface, probe, memory, state)) return {};
  SurfaceHold hold;
  if (memory.holding) {
    hold = surface.slide(probe);
  } else if (surface.may_tunnel() && memory.initialized && memory.has_value && memory.status == LinkStatus::free) {
    hold = surface.find_crossing(memory.probe, probe);
  }
  const bool on_its_way = memory.holding && hold.status == LinkStatus::budget;
  if (hold.found && !on_its_way && in_front(surface, rules, probe, hold.proxy) >= -kInFront * surface.domain_length()) return {};
  return hold;
}

}  // namespace

double max_proxy_travel(const SideMemory& memory, const Vec3& probe, double gap, const LinkState& state) noexcept {
  return memory.initialized ? state.max_travel(norm(probe - memory.probe), gap) : std::numeric_limits<double>::infinity();
}

Result<SideSpec> read_side_rules(const json::Node& link, bool has_sides, const BuildContext& context) {
  SideSpec spec;
  if (has_sides) CATENA_CHECK(schema::read_value(free_key(""), link, spec.free));
  if (link.find("snap") != nullptr) return spec;  // with "snap", snap.cpp does the release
  CATENA_TRY(spec.release, get_parameter(link, "release", 0.0, json::NumberRange::positive, context));
  return spec;
}

void start_on_surface(ContactSurface& surface, const SideRules& rules, const Vec3& probe, SideMemory& memory, LinkState& state) noexcept {
  memory = SideMemory{};
  state.released = false;
  SideValue side;
  leave(probe, 0, LinkStatus::free, state);
  if (rules.free != FreeSide::none) {
    side = surface.evaluate_side(probe);
    if (!side.is_known || is_free(rules, side.value)) return;
  }
  const SurfaceHold hold = surface.project_probe(probe);
  if (!hold.found && hold.status == LinkStatus::budget) state.status = LinkStatus::budget;
  if (!hold.found || !is_finite(hold.proxy)) return;
  if (rules.free != FreeSide::none && rules.release > 0 && norm(probe - hold.proxy) > rules.release) {
    state.released = true;
    return;
  }
  memory.holding = true;
  leave(hold.proxy, hold.residual, hold.status, state, hold.reason);
}

void advance_on_surface(ContactSurface& surface, const SideRules& rules, const Vec3& probe, SideMemory& memory, LinkState& state) noexcept {
  state.limit = rules.release;
  // skip a resting probe, unless the proxy was moved from outside or the data have changed
  const bool untouched = !memory.initialized || bitwise_equal(memory.proxy, state.proxy);
  if (memory.initialized && untouched && memory.settled && !state.data_changed && bitwise_equal(memory.probe, probe)) {
    leave(memory.proxy, memory.residual, memory.status, state, memory.reason);
    return;
  }
  if (!untouched) {
    const bool released = state.released;
    memory = SideMemory{};
    state.released = released;
  }

  // side of the probe, and re-engagement of a released link
  const bool one_sided = rules.free != FreeSide::none;
  SideValue side;
  if (one_sided || state.released) side = surface.evaluate_side(probe);
  const bool free = one_sided && side.is_known && is_free(rules, side.value);
  SurfaceHold hold;
  bool have_hold = false;
  if (state.released) {
    if (!one_sided) {
      const bool both = memory.initialized && memory.has_value && side.is_known;
      const bool crossed = both && (memory.value < 0) != (side.value < 0);
      if (crossed || (both && surface.may_tunnel())) hold = surface.find_crossing(memory.probe, probe);
      if (!hold.found) hold = surface.project_probe_within(probe, kRearmFraction * rules.release);
      have_hold = hold.found;
    }
    if (!free && !have_hold) {
      leave(probe, 0, LinkStatus::released, state);
      remember(probe, side, memory, state);
      return;
    }
    state.released = memory.holding = memory.beyond_body = false;
  }

  if (memory.gliding && !glide(rules, probe, memory, state)) return remember(probe, side, memory, state);

  // on the free side: free, or past the far side of a thin solid that still holds the proxy
  if (free) {
    hold = hold_beyond(surface, rules, probe, memory, state);
    if (!hold.found) {
      if (memory.holding && !glide(rules, probe, memory, state)) return remember(probe, side, memory, state);
      memory.holding = memory.beyond_body = false;
      leave(probe, 0, LinkStatus::free, state);
      remember(probe, side, memory, state);
      return;
    }
    have_hold = true;
  }
  memory.beyond_body = free;

  // unknown side: contact continues; a free proxy stays free unless the probe step crossed a sheet
  if (one_sided && !side.is_known && !memory.holding) {
    hold = hold_beyond(surface, rules, probe, memory, state);
    if (!hold.found) {
      if (side.is_not_finite)
        leave_broken(probe, state);
      else
        leave(probe, 0, LinkStatus::free, state);
      remember(probe, side, memory, state);
      return;
    }
    have_hold = true;
  }

  // in contact
  if (!have_hold) {
    if (memory.holding) {
      hold = surface.slide(probe);
    } else {
      if (one_sided && memory.initialized) hold = surface.find_crossing(memory.probe, probe);
      if (!hold.found) hold = surface.project_probe(probe);
    }
  }
  take(hold, rules, probe, memory, state);
  if (state.released && !side.is_known) side = surface.evaluate_side(probe);
  remember(probe, side, memory, state);
}

}  // namespace catena::haptics
