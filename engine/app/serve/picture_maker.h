/// PictureMaker draws without a window and keeps the last picture, to be encoded. Frame thread.
#pragma once
#include <memory>
#include <string>

#include "engine/app/serve/words.h"
#include "engine/app/viewer/shell/drawing.h"
#include "render/image/picture.h"
#include "render/passes/renderer.h"

namespace catena::app {

class PictureMaker {
 public:
  /// An error of the machine.
  static Result<PictureMaker> open(std::uint64_t memory_budget_bytes);

  /// That picture, of the page's size; what it took goes to `pacing` and `times`. An error of the machine; what cannot be extracted is
  /// bad input.
  Outcome draw(Drawing& drawing, Pacing& pacing, FrameTimes& times, const NextPicture& next, std::uint32_t width, std::uint32_t height);
  /// The last picture as a message. `exact`: PNG.
  Result<std::string> message(bool exact, std::uint32_t motion);

  /// Of the last picture, as render::DrawingClock counts; wall time where the device was lost on the way.
  double drawing_ms() const { return drawing_ms_; }
  bool has_picture() const { return !picture_.rgba.empty(); }
  render::Renderer& renderer() { return *renderer_; }

 private:
  Outcome make_renderer();

  std::uint64_t memory_budget_bytes_ = 0;
  std::unique_ptr<render::Renderer> renderer_;
  render::Picture picture_;
  PictureHead head_;
  double drawing_ms_ = 0;
};

}  // namespace catena::app
