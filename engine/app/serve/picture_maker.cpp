#include "engine/app/serve/picture_maker.h"

#include <optional>
#include <utility>

#include "engine/base/clock.h"
#include "render/image/encode.h"
#include "render/quality/quality.h"

namespace catena::app {

namespace {
constexpr int kJpegQuality = 85;

Error of_machine(const Error& error) { return {error.message, true}; }
}  // namespace

Result<PictureMaker> PictureMaker::open(std::uint64_t memory_budget_bytes) {
  PictureMaker maker;
  maker.memory_budget_bytes_ = memory_budget_bytes;
  CATENA_CHECK(maker.make_renderer());
  return maker;
}

Outcome PictureMaker::make_renderer() {
  renderer_.reset();
  render::vk::DeviceOptions device;
  device.memory_budget_bytes = memory_budget_bytes_;
  auto made = render::Renderer::create(device);
  if (!made) return of_machine(made.error());
  renderer_ = std::move(*made);
  return Done{};
}

Outcome PictureMaker::draw(Drawing& drawing, Pacing& pacing, FrameTimes& times, const NextPicture& next, std::uint32_t width,
                           std::uint32_t height) {
  std::int64_t start = now_ns();
  CATENA_TRY(render::FramePacket packet, drawing.packet(next, width, height));
  if (pacing.wants_estimate()) {
    if (auto known = drawing.estimate_if_wanted(*renderer_, packet, next); !known) return of_machine(known.error());
    start = now_ns();
  }
  std::optional<render::DrawingClock> clock(*renderer_);
  auto drawn = renderer_->draw(packet, next.settings);
  if (!drawn && renderer_->device().lost()) {
    clock.reset();  // its renderer goes
    CATENA_CHECK(make_renderer());
    drawn = renderer_->draw(packet, next.settings);
  }
  if (!drawn) return of_machine(drawn.error());
  const double drawing_ms = clock ? clock->ms() : 0;
  auto picture = renderer_->read_back();
  if (!picture) return of_machine(picture.error());
  picture_ = std::move(*picture);
  const double ms = ms_since(start);
  drawing_ms_ = clock ? drawing_ms : ms;
  pacing.drawn(ms);
  times.add(ms, now_ns());
  drawing.drawn(std::move(packet), *renderer_);
  head_ = {head_.number, 0, width, height, false, ms};
  return Done{};
}

Result<std::string> PictureMaker::message(bool exact, std::uint32_t motion) {
  const std::int64_t start = now_ns();
  CATENA_TRY(const std::string file, exact ? render::png_bytes(picture_) : render::jpeg_bytes(picture_, kJpegQuality));
  PictureHead head = head_;
  head.number = ++head_.number;
  head.motion = motion;
  head.exact = exact;
  head.ms += ms_since(start);
  return picture_bytes(head, file);
}

}  // namespace catena::app
