// SPDX-License-Identifier: MIT
/// Render time, excluding other programs on the machine: on a GPU by its own clock (render/vk/timestamp_query.h); with a CPU driver from
/// the processor time of the process; on a GPU without a clock wall time. Frame thread.
#pragma once
#include "render/passes/renderer.h"

namespace catena::render {

/// Measures work from construction to elapsed_ms(). The renderer must outlive it.
class RenderTimer {
 public:
  enum class ClockSource { cpu, gpu, wall };
  explicit RenderTimer(Renderer& renderer);
  RenderTimer(Renderer& renderer, ClockSource by);  ///< for tests
  /// Returns the milliseconds since construction by this clock.
  double elapsed_ms() const;

 private:
  double now_ns() const;
  Renderer* renderer_;
  ClockSource source_;
  double start_ns_;
};

/// Renders the packet and returns the milliseconds it took.
Result<double> measure_render_ms(Renderer& renderer, const FramePacket& packet, const RenderSettings& settings);

}  // namespace catena::render
