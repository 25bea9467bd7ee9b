#include "engine/app/viewer/shell/screen.h"

#include <algorithm>

namespace catena::app {

Result<std::unique_ptr<Screen>> Screen::open(Window& window, Options options) {
  std::unique_ptr<Screen> screen(new Screen(window, std::move(options)));
  CATENA_CHECK(screen->make());
  return screen;
}

Outcome Screen::make() {
  has_picture_ = is_shown_ = false;
  if (options_.before_making) options_.before_making();
  swapchain_.reset();
  renderer_.reset();
  render::vk::DeviceOptions device;
  device.surface = window_.surface_factory();
  device.memory_budget_bytes = options_.memory_budget_bytes;
  device.fail = options_.fail;
  if (options_.maker) device.maker = options_.maker();
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

/// The device was lost: another one. Once for every picture: what is lost again at once is an error.
Outcome Screen::recover() {
  CATENA_CHECK(make());
  ++recoveries_;
  return Done{};
}

Outcome Screen::make_again() { return renderer_ && renderer_->device().lost() ? recover() : make(); }

Outcome Screen::draw(const render::FramePacket& packet, const render::RenderSettings& settings) {
  auto drawn = renderer_->draw(packet, settings);
  if (!drawn && renderer_->device().lost()) {
    CATENA_CHECK(recover());
    drawn = renderer_->draw(packet, settings);
  }
  has_picture_ = static_cast<bool>(drawn);
  return drawn;
}

Outcome Screen::show(const render::UiItems& ui) {
  std::uint32_t width = 0, height = 0;
  size(width, height);
  if (width == 0 || height == 0 || !has_picture_) return Done{};
  const auto shown = [&]() -> Outcome {
    if (is_resized()) CATENA_CHECK(swapchain_->resize(width, height));
    CATENA_TRY(fits_, renderer_->present(*swapchain_, &ui));
    return Done{};
  }();
  constexpr int kMaxLosses = 3;
  if (!shown && renderer_->device().lost() && ++losses_ <= kMaxLosses) return recover();
  if (shown) losses_ = 0;
  is_shown_ = is_shown_ || shown;
  return shown;
}

std::optional<render::Picked> Screen::pick(double x, double y) {
  if (!has_picture_) return std::nullopt;
  const auto [width, height] = renderer_->view_size();
  if (!(x >= 0 && y >= 0 && x < width && y < height)) return std::nullopt;
  const auto picked = renderer_->pick(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
  if (picked) return *picked;
  // the next picture finds out what is wrong
  has_picture_ = false;
  return std::nullopt;
}

Result<render::Picture> Screen::window_picture() { return renderer_->read_back_window(); }

}  // namespace catena::app
