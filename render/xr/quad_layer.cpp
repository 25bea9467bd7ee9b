// SPDX-License-Identifier: MIT
#include "render/xr/quad_layer.h"

namespace catena::render::xr {

Result<std::unique_ptr<QuadLayer>> QuadLayer::create(Session& session, ViewSize size) {
  std::unique_ptr<QuadLayer> self(new QuadLayer(session));
  CATENA_TRY(self->images_, SwapchainImages::create(session, size));
  return self;
}

Outcome QuadLayer::submit_image(vk::Image& image) {
  CATENA_CHECK(images_->submit_image(image));
  image_size_ = {image.info().extent.width, image.info().extent.height};
  return Done{};
}

const XrCompositionLayerBaseHeader* QuadLayer::composition_layer() {
  if (image_size_.width == 0) return nullptr;
  layer_ = {};
  layer_.type = XR_TYPE_COMPOSITION_LAYER_QUAD;
  if (!quad_.opaque)
    layer_.layerFlags = XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT | XR_COMPOSITION_LAYER_UNPREMULTIPLIED_ALPHA_BIT;
  layer_.space = session_->space(SpaceKind::local);
  layer_.eyeVisibility = XR_EYE_VISIBILITY_BOTH;
  layer_.subImage.swapchain = images_->handle();
  layer_.subImage.imageRect.extent = {std::int32_t(image_size_.width), std::int32_t(image_size_.height)};
  layer_.pose.orientation = {float(quad_.pose.orientation.x), float(quad_.pose.orientation.y), float(quad_.pose.orientation.z),
                             float(quad_.pose.orientation.w)};
  layer_.pose.position = {float(quad_.pose.position.x), float(quad_.pose.position.y), float(quad_.pose.position.z)};
  layer_.size = {float(quad_.width_m), float(quad_.height_m)};
  return reinterpret_cast<const XrCompositionLayerBaseHeader*>(&layer_);
}

}  // namespace catena::render::xr
