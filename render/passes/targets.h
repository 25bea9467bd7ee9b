/// The images that passes hand to each other, created when a pass first needs them and again when the size changes.
#pragma once
#include "render/vk/resources.h"

namespace catena::render {

inline constexpr VkFormat kOpaqueFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
inline constexpr VkFormat kDepthValueFormat = VK_FORMAT_R32_SFLOAT;  ///< depth t of shared/frame.h
inline constexpr VkFormat kDepthBufferFormat = VK_FORMAT_D32_SFLOAT;
inline constexpr VkFormat kVolumeFormat = VK_FORMAT_R32G32B32A32_SFLOAT;  ///< premultiplied
inline constexpr VkFormat kPictureFormat = VK_FORMAT_R8G8B8A8_UNORM;      ///< straight alpha

struct Targets {
  vk::Image opaque_color, opaque_depth, depth_buffer, volume, picture;
  vk::Image none;  ///< one texel, bound where a pass has no input

  Outcome ensure(vk::Device& device, std::uint32_t width, std::uint32_t height, bool opaque, bool has_volume);
};

}  // namespace catena::render
