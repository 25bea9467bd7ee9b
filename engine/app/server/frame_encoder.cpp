// SPDX-License-Identifier: MIT
#include "engine/app/server/frame_encoder.h"

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

Result<FrameEncoder> FrameEncoder::open(std::uint64_t memory_budget_bytes) {
  FrameEncoder maker;
  maker.memory_budget_bytes_ = memory_budget_bytes;
  CATENA_CHECK(maker.make_renderer());
  return maker;
}

Outcome FrameEncoder::make_renderer() {
  renderer_.reset();
  render::vk::DeviceOptions device;
  device.memory_budget_bytes = memory_budget_bytes_;
  auto made = render::Renderer::create(device);
  if (!made) return of_machine(made.error());
  renderer_ = std::move(*made);
  return Done{};
}

Outcome FrameEncoder::draw(FrameBuilder& drawing, ProgressiveScheduler& pacing, FrameTimes& times, const FrameRequest& next,
                           std::uint32_t width, std::uint32_t height) {
  std::int64_t start = now_ns();
  CATENA_TRY(render::FramePacket packet, drawing.make_packet(next, width, height));
  if (pacing.needs_estimate()) {
    if (auto known = drawing.estimate_error_if_needed(*renderer_, packet, next); !known) return of_machine(known.error());
    start = now_ns();
  }
  std::optional<render::RenderTimer> clock(*renderer_);
  auto drawn = renderer_->draw(packet, next.settings);
  if (!drawn && renderer_->device().is_lost()) {
    clock.reset();  // the clock's renderer is about to be destroyed
    CATENA_CHECK(make_renderer());
    drawn = renderer_->draw(packet, next.settings);
  }
  if (!drawn) return of_machine(drawn.error());
  const double drawing_ms = clock ? clock->elapsed_ms() : 0;
  auto picture = renderer_->read_back();
  if (!picture) return of_machine(picture.error());
  image_ = std::move(*picture);
  const double ms = ms_since(start);
  render_ms_ = clock ? drawing_ms : ms;
  pacing.on_rendered(ms);
  times.add(ms, now_ns());
  drawing.on_rendered(std::move(packet), *renderer_);
  header_ = {header_.number, 0, width, height, false, ms};
  return Done{};
}

Result<std::string> FrameEncoder::encode_message(bool exact, std::uint32_t motion) {
  const std::int64_t start = now_ns();
  CATENA_TRY(const std::string file, exact ? render::encode_png(image_) : render::encode_jpeg(image_, kJpegQuality));
  FrameHeader head = header_;
  head.number = ++header_.number;
  head.input_number = motion;
  head.is_lossless = exact;
  head.elapsed_ms += ms_since(start);
  return frame_message(head, file);
}

}  // namespace catena::app
