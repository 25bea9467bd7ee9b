/// How a thing is drawn into the opaque targets or into a translucent layer: the bindings and constants of shaders/lib/peel.glsl.
#pragma once
#include "render/passes/pass.h"
#include "shaders/shared/layers.h"

namespace catena::render {

/// Where something is drawn.
struct Peel {
  std::uint32_t mode = MODE_OPAQUE;
  const vk::Image* opaque_depth = nullptr;  ///< null: nothing opaque
  const vk::Image* passed_depth = nullptr;  ///< of the layer before; null: there is none
  const vk::Image* passed_id = nullptr;
  const vk::Image* none = nullptr;     ///< bound where the others are null
  const vk::Image* none_id = nullptr;  ///< the same for ids

  bool has_opaque() const { return opaque_depth != nullptr; }
};

inline constexpr VkFormat kRestFormat = VK_FORMAT_R32G32B32A32_SFLOAT;  ///< what lies behind the layers, collected

/// Slots, targets, depth and blending of a pipeline for a mode; constants 1 and 2 follow the caller's constant 0.
void set_peel_stage(vk::GraphicsInfo& info, std::uint32_t mode, bool has_opaque);
void add_peel_bindings(std::vector<vk::Binding>& bindings, const Peel& peel, const vk::Buffer& layer_data);
shared::LayerData layer_data(const CameraRays& rays, float opacity);

}  // namespace catena::render
