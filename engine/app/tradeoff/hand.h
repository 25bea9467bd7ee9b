/// A scene written as text and the hand that feels it: the very tick of `replay`, step by step.
#pragma once
#include <memory>
#include <string>

#include "haptics/chain/tick.h"

namespace catena::app {

class Hand {
 public:
  /// The text is ours: a mistake in it is a bug.
  explicit Hand(const std::string& scene);
  const exchange::HapticState& at(double t_s, const Vec3& probe) {
    haptics::tick(*program_, {t_s, probe, 0}, *state_, *scratch_, out_);
    return out_;
  }

 private:
  std::shared_ptr<const haptics::Program> program_;
  std::unique_ptr<haptics::ChainState> state_;
  std::unique_ptr<haptics::ChainScratch> scratch_;
  exchange::HapticState out_;
};

/// "[x, y, z]" as a scene file has it.
std::string to_json(const Vec3& v);

}  // namespace catena::app
