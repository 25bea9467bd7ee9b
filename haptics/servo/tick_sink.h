/// Who wants every tick: the recording (haptics/servo/log/). Called on the haptic thread after each tick, before it is
/// published: no allocation, lock or throw, and it returns at once. `begin` comes before the first `put` of a sink that is taken up.
#pragma once
#include "haptics/chain/tick.h"

namespace catena::haptics {

class TickSink {
 public:
  virtual ~TickSink() = default;
  /// A sink that a running servo takes up: the state before the tick that `put` gets next.
  virtual void begin(const ChainState& state) noexcept { static_cast<void>(state); }
  /// `input` and `output` as the tick had them; the servo's timings are in `output`.
  virtual void put(const ProbeSample& input, const exchange::HapticState& output) noexcept = 0;
};

}  // namespace catena::haptics
