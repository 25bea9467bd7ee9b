#include "engine/app/viewer/screen.h"

#include <algorithm>

namespace catena::app {

Result<std::unique_ptr<Screen>> Screen::open(Window& window, Options options) {
  std::unique_ptr<Screen> screen(new Screen(window, std::move(options)));
  CATENA_CHECK(screen->make());
  return screen;
}

Outcome Screen::make() {
  swapchain_.reset();
  renderer_.reset();
  render::vk::DeviceOptions device;
  device.surface = window_.surface_factory();
  device.memory_budget_bytes = options_.memory_budget_bytes;
  device.fail = options_.fail;
  CATENA_TRY(renderer_, render::Renderer::create(device));
  std::uint32_t width = 0, height = 0;
  size(width, height);
  CATENA_TRY(swapchain_, render::vk::Swapchain::create(renderer_->device(), std::max(1u, width), std::max(1u, height)));
  fits_ = true;
  return Done{};
}

bool Screen::is_resized() const {
  std::uint32_t width = 0, height = 0;
  size(width, height);
  return !fits_ || width != swapchain_->extent().width || height != swapchain_->extent().height;
}

Outcome Screen::draw(const render::FramePacket& packet, const render::RenderSettings& settings) {
  auto drawn = renderer_->draw(packet, settings);
  if (drawn || !renderer_->device().lost()) return drawn;
  CATENA_CHECK(make());
  ++recoveries_;
  return renderer_->draw(packet, settings);
}

Outcome Screen::show(const render::UiItems& ui) {
  std::uint32_t width = 0, height = 0;
  size(width, height);
  if (width == 0 || height == 0) return Done{};
  if (is_resized()) CATENA_CHECK(swapchain_->resize(width, height));
  CATENA_TRY(fits_, renderer_->present(*swapchain_, &ui));
  return Done{};
}

Result<render::Picture> Screen::window_picture() { return renderer_->read_back_window(); }

}  // namespace catena::app
