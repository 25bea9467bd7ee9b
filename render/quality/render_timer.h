/// What drawing takes, such that other programs on the machine do not count: of a GPU by its own clock (render/vk/timestamp_query.h); of a
/// driver that draws with the processor what its cores had to do; of a GPU without a clock wall time. Frame thread.
#pragma once
#include "render/passes/renderer.h"

namespace catena::render {

/// Of any work, from its making to ms(); the renderer outlives it.
class RenderTimer {
 public:
  enum class ClockSource { cpu, gpu, wall };
  explicit RenderTimer(Renderer& renderer);
  RenderTimer(Renderer& renderer, ClockSource by);  ///< for tests
  double elapsed_ms() const;

 private:
  double now_ns() const;
  Renderer* renderer_;
  ClockSource source_;
  double start_ns_;
};

/// Milliseconds of drawing a packet.
Result<double> measure_render_ms(Renderer& renderer, const FramePacket& packet, const RenderSettings& settings);

}  // namespace catena::render
