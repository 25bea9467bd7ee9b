/// FrameEncoder draws without a window and keeps the last picture, to be encoded. Frame thread.
#pragma once
#include <memory>
#include <string>

#include "engine/app/server/server_messages.h"
#include "engine/app/viewer/window/frame_builder.h"
#include "render/image/image.h"
#include "render/passes/renderer.h"

namespace catena::app {

class FrameEncoder {
 public:
  /// An error of the machine.
  static Result<FrameEncoder> open(std::uint64_t memory_budget_bytes);

  /// That picture, of the page's size; what it took goes to `pacing` and `times`. An error of the machine; what cannot be extracted is
  /// bad input.
  Outcome draw(FrameBuilder& drawing, ProgressiveScheduler& pacing, FrameTimes& times, const FrameRequest& next, std::uint32_t width,
               std::uint32_t height);
  /// The last picture as a message. `exact`: PNG.
  Result<std::string> encode_message(bool exact, std::uint32_t motion);

  /// Of the last picture, as render::RenderTimer counts; wall time where the device was lost on the way.
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
