#include "haptics/chain/check_state.h"

#include <algorithm>

#include "haptics/chain/state_hash.h"

namespace catena::haptics {

namespace {

constexpr std::int32_t kMaxCounted = 1 << 20;  // of what is counted up within a few ticks

bool is_sane(const Order& order) {
  if (order.count < 0 || order.count > kMaxLinks || order.mode < -1 || order.mode >= kMaxModes) return false;
  for (int k = 0; k < order.count; ++k)
    if (const auto link = order.links[static_cast<std::size_t>(k)]; link < 0 || link >= kMaxLinks) return false;
  return true;
}

bool is_sane(const LinkState& link) {
  return is_one_of(link.status, Status::bad_probe) && are_bools(link.started, link.released, link.on) &&
         is_one_of(link.shape.kind, widget::Shape::Kind::point) && link.evaluations >= 0 && link.evaluations <= kMaxCounted &&
         link.steps >= 0 && link.steps <= kMaxCounted && is_one_of(link.reason, Reason::parallel);
}

bool is_sane(const SingleProxy& single) {
  for (const SingleProxy::Watch& watch : single.watches)
    if (!are_bools(watch.known, watch.released, watch.holds)) return false;
  return are_bools(single.started, single.settled);
}

bool are_sane(const std::array<IndicationState, kMaxLinks>& indications) {
  for (const IndicationState& indication : indications)
    if (!are_bools(indication.left, indication.fresh)) return false;
  return true;
}

bool is_sane(const GuardState& guard) {
  return is_one_of(guard.force_state, ForceState::stopped) && guard.late >= 0 && guard.late <= kMaxCounted;
}

bool is_sane(const PassivityState& ledger) {
  return are_bools(ledger.anew) && are_bools(ledger.apart) && is_sane(ledger.order) && ledger.next < PassivityState::kPast;
}

bool are_sane(const Program& program, const WidgetsState& state) {
  const auto count = static_cast<int>(std::min<std::size_t>(program.widgets.size(), widget::kMaxWidgets));
  if (!are_bools(state.started, state.gone) || state.engaged < -1 || state.engaged >= count) return false;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
    if (!widget::is_sane(program.widgets[i], state.widgets[i])) return false;
  return true;
}

}  // namespace

Outcome check_state(const Program& program, const ChainState& state) {
  const bool chain = are_bools(state.has_probe) && are_bools(state.left_out.known) && is_sane(state.order) && is_sane(state.single) &&
                     is_sane(state.guard) && is_sane(state.passivity) && are_bools(state.switches.link_on) &&
                     are_bools(state.switches.mode_on) && are_sane(state.indications) && is_finite(state.last_probe) &&
                     is_finite(state.force_n);
  if (!chain) return Error{"the state of the chain is damaged or forged: expected one that a tick leaves"};
  if (!are_sane(program, state.widgets)) return Error{"the state of the widgets is damaged or forged: expected one that a tick leaves"};
  for (std::size_t i = 0; i < program.links.size(); ++i)
    if (!is_sane(state.links[i]) || !program.links[i].constraint->is_sane(state.links[i]))
      return Error{"the state of link \"" + program.links[i].name +
                   "\" is damaged or forged, or of another scene: expected one that its constraint leaves"};
  return Done{};
}

}  // namespace catena::haptics
