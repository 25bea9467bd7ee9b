// SPDX-License-Identifier: MIT
#include "engine/app/viewer/window/presenter.h"

#include <algorithm>

namespace catena::app {

Result<std::unique_ptr<Presenter>> Presenter::open(Window& window, Options options) {
  std::unique_ptr<Presenter> screen(new Presenter(window, std::move(options)));
  CATENA_CHECK(screen->create_device());
  return screen;
}

Outcome Presenter::create_device() {
  has_image_ = has_presented_ = false;
  if (options_.before_device_created) options_.before_device_created();
  swapchain_.reset();
  renderer_.reset();
  render::vk::DeviceOptions device;
  device.surface = window_.surface_factory();
  device.memory_budget_bytes = options_.memory_budget_bytes;
  device.inject_failure = options_.inject_failure;
  if (options_.vulkan_maker) device.provider = options_.vulkan_maker();
  CATENA_TRY(renderer_, render::Renderer::create(device));
  std::uint32_t width = 0, height = 0;
  size(width, height);
  CATENA_TRY(swapchain_, render::vk::Swapchain::create(renderer_->device(), std::max(1u, width), std::max(1u, height)));
  size_matches_ = true;
  return Done{};
}

bool Presenter::is_resized() const {
  std::uint32_t width = 0, height = 0;
  size(width, height);
  return !size_matches_ || width != swapchain_->extent().width || height != swapchain_->extent().height;
}

/// Recreates the device after a loss, at most once per frame: a repeated loss is an error.
Outcome Presenter::recover() {
  CATENA_CHECK(create_device());
  ++recovery_count_;
  return Done{};
}

Outcome Presenter::recreate() { return renderer_ && renderer_->device().is_lost() ? recover() : create_device(); }

Outcome Presenter::draw(const render::FramePacket& packet, const render::RenderSettings& settings) {
  auto drawn = renderer_->draw(packet, settings);
  if (!drawn && renderer_->device().is_lost()) {
    CATENA_CHECK(recover());
    drawn = renderer_->draw(packet, settings);
  }
  has_image_ = static_cast<bool>(drawn);
  return drawn;
}

Outcome Presenter::show(const render::UiItems& ui) {
  std::uint32_t width = 0, height = 0;
  size(width, height);
  if (width == 0 || height == 0 || !has_image_) return Done{};
  const auto shown = [&]() -> Outcome {
    if (is_resized()) CATENA_CHECK(swapchain_->resize(width, height));
    CATENA_TRY(size_matches_, renderer_->present(*swapchain_, &ui));
    return Done{};
  }();
  constexpr int kMaxLosses = 3;
  if (!shown && renderer_->device().is_lost() && ++consecutive_losses_ <= kMaxLosses) return recover();
  if (shown) consecutive_losses_ = 0;
  has_presented_ = has_presented_ || shown;
  return shown;
}

std::optional<render::PickResult> Presenter::pick(double x, double y) {
  if (!has_image_) return std::nullopt;
  const auto [width, height] = renderer_->view_size();
  if (!(x >= 0 && y >= 0 && x < width && y < height)) return std::nullopt;
  const auto picked = renderer_->pick(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
  if (picked) return *picked;
  // the next frame reports the error
  has_image_ = false;
  return std::nullopt;
}

Result<render::Image8> Presenter::capture_window() { return renderer_->read_back_window(); }

}  // namespace catena::app
