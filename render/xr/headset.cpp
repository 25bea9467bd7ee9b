#include "render/xr/headset.h"

#include <algorithm>
#include <cmath>

namespace catena::render::xr {

Result<std::unique_ptr<Headset>> Headset::open(const char* library) {
  CATENA_TRY(std::unique_ptr<Instance> instance, Instance::open(library));
  return std::unique_ptr<Headset>(new Headset(std::move(instance)));
}

Outcome Headset::start(vk::Device& device) {
  stop();
  CATENA_TRY(session_, Session::create(*instance_, device));
  for (const ViewSize& size : instance_->views()) {
    auto images = EyeImages::create(*session_, size);
    if (!images) {
      stop();
      return images.error();
    }
    images_.push_back(std::move(*images));
  }
  return Done{};
}

void Headset::stop() {
  images_.clear();
  session_.reset();
}

Result<Frame> Headset::draw(Renderer& renderer, FramePacket& packet, const RenderSettings& settings, const Placement& placement,
                            double share) {
  CATENA_TRY(Frame frame, begin_frame(*session_));
  ++counts_.frames;
  std::vector<Shown> shown;
  if (frame.wants_picture) {
    auto drawn = draw_views(frame, renderer, packet, settings, placement, share);
    if (!drawn) {
      (void)end_frame(*session_, frame, {});
      return drawn.error();
    }
    shown = std::move(*drawn);
    ++counts_.pictures;
  }
  CATENA_CHECK(end_frame(*session_, frame, shown));
  return frame;
}

Result<std::vector<Shown>> Headset::draw_views(const Frame& frame, Renderer& renderer, FramePacket& packet, const RenderSettings& settings,
                                               const Placement& placement, double share) {
  const auto scaled = [&](std::uint32_t pixels) { return std::max(1u, std::uint32_t(std::lround(share * pixels))); };
  std::vector<Shown> shown(frame.views.size());
  packet.eyes.clear();
  packet.packing = Packing::single;
  for (std::size_t k = frame.views.size(); k-- > 0;) {
    const ViewSize size = images_[k]->size();
    packet.width = scaled(size.width);
    packet.height = scaled(size.height);
    CATENA_TRY(packet.view, eye_view(placement, room_eye(frame.views[k])));
    CATENA_CHECK(renderer.draw(packet, settings));
    CATENA_CHECK(images_[k]->take(renderer.picture()));
    shown[k] = {images_[k].get(), {packet.width, packet.height}};
  }
  return shown;
}

}  // namespace catena::render::xr
