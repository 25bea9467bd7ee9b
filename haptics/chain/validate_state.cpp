// SPDX-License-Identifier: MIT
#include "haptics/chain/validate_state.h"

#include <algorithm>

#include "haptics/chain/bricks.h"
#include "haptics/chain/state_hash.h"

namespace catena::haptics {

namespace {

constexpr std::int32_t kMaxCounted = 1 << 20;  // upper bound of counters that grow only within a few ticks

bool is_sane(const LinkOrder& order) {
  if (order.count < 0 || order.count > kMaxLinks || order.mode < -1 || order.mode >= kMaxModes) return false;
  for (int k = 0; k < order.count; ++k)
    if (const auto link = order.links[static_cast<std::size_t>(k)]; link < 0 || link >= kMaxLinks) return false;
  return true;
}

bool is_sane(const LinkState& link) {
  return is_valid_enum(link.status, LinkStatus::bad_probe) &&
         are_valid_bools(link.started, link.released, link.switched_on, link.data_changed, link.is_coarse) &&
         is_valid_enum(link.shape.kind, widget::LinkShape::Kind::point) && link.evaluations >= 0 && link.evaluations <= kMaxCounted &&
         link.other_work >= 0 && link.other_work <= kMaxCounted && is_valid_enum(link.reason, SampleStatus::parallel);
}

bool is_sane(const SingleProxyState& single) {
  for (const SingleProxyState::ReleaseState& watch : single.release_states)
    if (!are_valid_bools(watch.has_height, watch.released, watch.was_holding)) return false;
  return are_valid_bools(single.has_proxy, single.settled);
}

bool are_sane(const std::array<ReleaseCueState, kMaxLinks>& indications) {
  for (const ReleaseCueState& indication : indications)
    if (!are_valid_bools(indication.released, indication.initialized)) return false;
  return true;
}

bool is_sane(const ForceLimiterState& guard) {
  return is_valid_enum(guard.force_state, ForceState::stopped) && guard.late_ticks >= 0 && guard.late_ticks <= kMaxCounted;
}

bool is_sane(const PassivityState& ledger) {
  return are_valid_bools(ledger.rebase_pending) && are_valid_bools(ledger.detached) && is_sane(ledger.order) &&
         ledger.next_index < PassivityState::kHistoryLength;
}

bool are_sane(const HapticProgram& program, const WidgetsState& state) {
  const auto count = static_cast<int>(std::min<std::size_t>(program.widgets.size(), kMaxWidgets));
  if (!are_valid_bools(state.has_probe, state.probe_lost) || state.engaged < -1 || state.engaged >= count) return false;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
    if (!widget::is_valid_state(program.widgets[i], state.widgets[i])) return false;
  return true;
}

}  // namespace

Outcome validate_state(const HapticProgram& program, const ChainState& state) {
  const bool chain = are_valid_bools(state.has_probe) && are_valid_bools(state.unaccounted.has_previous) && is_sane(state.order) &&
                     state.limited_ticks >= 0 && state.limited_ticks <= kLimitedTicks && is_sane(state.single_proxy) &&
                     is_sane(state.force_limiter) && is_sane(state.passivity) && are_valid_bools(state.switches.link_on) &&
                     are_valid_bools(state.switches.mode_on) && are_sane(state.release_cues) && is_finite(state.last_probe) &&
                     is_finite(state.chain_force_n);
  if (!chain) return Error{"the state of the chain is damaged or forged, expected the state after a tick"};
  if (!are_sane(program, state.widgets)) return Error{"the state of the widgets is damaged or forged, expected the state after a tick"};
  for (std::size_t i = 0; i < program.links.size(); ++i)
    if (!is_sane(state.links[i]) || !program.links[i].constraint->is_sane(state.links[i]))
      return Error{"the state of link \"" + program.links[i].name +
                   "\" is damaged, forged or from another scene, expected a state written by the link's constraint"};
  return Done{};
}

}  // namespace catena::haptics
