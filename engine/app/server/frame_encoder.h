// SPDX-License-Identifier: MIT
/// FrameEncoder renders frames without a window and encodes the last one. Frame thread.
#pragma once
#include <memory>
#include <string>

#include "engine/app/server/server_messages.h"
#include "engine/app/viewer/window/frame_builder.h"
#include "render/image/image.h"
#include "render/passes/renderer.h"

namespace catena::app {

/// Owns the renderer and the last image.
class FrameEncoder {
 public:
  /// Creates the renderer. `memory_budget_bytes`: limit of GPU memory, 0: what the driver reports. Error: a system failure.
  static Result<FrameEncoder> open(std::uint64_t memory_budget_bytes);

  /// Renders the requested frame at the page's size; reports its time to `pacing` and `times`. If the device is lost, the renderer is
  /// created anew and the frame rendered again. Error: a system failure, or bad input if the scene cannot be extracted.
  Outcome draw(FrameBuilder& drawing, ProgressiveScheduler& pacing, FrameTimes& times, const FrameRequest& next, std::uint32_t width,
               std::uint32_t height);
  /// Encodes the last image as a message. `exact`: PNG, else JPEG; `motion`: number of the newest input that it shows.
  Result<std::string> encode_message(bool exact, std::uint32_t motion);

  /// Render time of the last frame, ms, as measured by render::RenderTimer; wall time if the device was lost.
  double render_ms() const { return render_ms_; }
  bool has_image() const { return !image_.rgba.empty(); }
  render::Renderer& renderer() { return *renderer_; }

 private:
  Outcome make_renderer();

  std::uint64_t memory_budget_bytes_ = 0;
  std::unique_ptr<render::Renderer> renderer_;
  render::Image8 image_;
  FrameHeader header_;
  double render_ms_ = 0;
};

}  // namespace catena::app
