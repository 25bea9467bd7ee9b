#include "haptics/chain/rebind.h"

namespace catena::haptics {

void rebind(const Program& from, const Program& to, ChainState& state, ChainScratch& scratch) noexcept {
  const std::array<LinkState, kMaxLinks> old = state.links;
  scratch = ChainScratch{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(kMaxLinks); ++i) {
    state.links[i] = LinkState{};
    if (i >= to.links.size()) continue;
    for (std::size_t k = 0; k < from.links.size(); ++k) {
      if (from.links[k].name == to.links[i].name && from.links[k].constraint == to.links[i].constraint) state.links[i] = old[k];
    }
  }
}

}  // namespace catena::haptics
