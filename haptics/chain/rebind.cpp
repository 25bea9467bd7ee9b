#include "haptics/chain/rebind.h"

namespace catena::haptics {

namespace {

bool keeps(const Link& from, const Link& to) noexcept {
  return from.name == to.name && (from.recipe != 0 ? from.recipe == to.recipe : from.constraint == to.constraint);
}

}  // namespace

void rebind(const Program& from, const Program& to, ChainState& state, ChainScratch& scratch) noexcept {
  const ChainState old = state;
  scratch = ChainScratch{};
  state.fade.replaced = state.alignment.fade.replaced = true;
  state.alignment.axes = {};
  state.passivity.anew = true;
  if (from.coupling.method != to.coupling.method) state.single = SingleProxy{};
  state.fade.shares = old.fade.shares;
  for (std::size_t i = 0; i < static_cast<std::size_t>(kMaxLinks); ++i) {
    state.links[i] = LinkState{};
    state.indications[i] = IndicationState{};
    state.single.watches[i] = {};
    state.switches.link_on[i] = false;
    state.passivity.given_j[i] = state.passivity.stored_j[i] = state.passivity.weights[i] = 0;
    state.passivity.sent_n[i] = Vec3(0.0);
    if (i >= to.links.size()) continue;
    for (std::size_t k = 0; k < from.links.size(); ++k) {
      if (!keeps(from.links[k], to.links[i])) continue;
      state.links[i] = old.links[k];
      state.indications[i] = old.indications[k];
      if (from.coupling.method == to.coupling.method) state.single.watches[i] = old.single.watches[k];
      state.switches.link_on[i] = old.switches.link_on[k];
      // the ledger of a link goes on; what links that are gone have given stays in the observer
      state.passivity.given_j[i] = old.passivity.given_j[k];
      state.passivity.stored_j[i] = old.passivity.stored_j[k];
      state.passivity.weights[i] = old.passivity.weights[k];
      state.passivity.sent_n[i] = old.passivity.sent_n[k];
    }
  }
  rebind_widgets(from, to, state.widgets);
  for (std::size_t i = 0; i < static_cast<std::size_t>(kMaxModes); ++i) {
    state.switches.mode_on[i] = false;
    if (i >= to.modes.size()) continue;
    for (std::size_t k = 0; k < from.modes.size(); ++k)
      if (from.modes[k].name == to.modes[i].name) state.switches.mode_on[i] = old.switches.mode_on[k];
  }
}

}  // namespace catena::haptics
