/// The images that passes hand to each other, created when a pass first needs them and again when the size changes.
#pragma once
#include <array>
#include <vector>

#include "render/raycast/ray_scene.h"
#include "render/vk/commands.h"
#include "render/vk/resources.h"

namespace catena::render {

/// A set of targets, by bits.
using TargetSet = unsigned;
namespace target {
inline constexpr TargetSet opaque_color = 1, opaque_depth = 2, opaque_id = 4, depth_buffer = 8, volume = 16, picture = 32;
/// Everything that solid things draw into.
inline constexpr TargetSet opaque = opaque_color | opaque_depth | opaque_id | depth_buffer;
}  // namespace target

inline constexpr VkFormat kOpaqueFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
inline constexpr VkFormat kDepthValueFormat = VK_FORMAT_R32_SFLOAT;  ///< depth t of shared/frame.h
inline constexpr VkFormat kIdFormat = VK_FORMAT_R32_UINT;            ///< the object's id, 0: none
inline constexpr VkFormat kDepthBufferFormat = VK_FORMAT_D32_SFLOAT;
inline constexpr VkFormat kPictureFormat = VK_FORMAT_R8G8B8A8_UNORM;            ///< straight alpha
inline constexpr VkFormat kFloatPictureFormat = VK_FORMAT_R32G32B32A32_SFLOAT;  ///< the same, not rounded

/// The formats of a pipeline that draws into target::opaque, in the order of its outputs.
std::vector<VkFormat> opaque_formats();

struct Targets {
  vk::Image opaque_color, opaque_depth, opaque_id, depth_buffer, volume, picture;
  VkFormat picture_format = kPictureFormat;  ///< or kFloatPictureFormat; pipelines that draw into the picture follow it
  vk::Image none;                            ///< one texel, bound where a pass has no input

  Outcome ensure(vk::Device& device, std::uint32_t width, std::uint32_t height, TargetSet needed);
  /// Bytes that ensure() would have to add for these.
  std::uint64_t bytes_to_come(std::uint32_t width, std::uint32_t height, TargetSet needed) const;
  vk::Image& image(TargetSet one);
  /// Begins rendering into `writes`; what `cleared` names starts empty, the rest keeps what is there.
  void begin(vk::Commands& commands, TargetSet writes, TargetSet cleared);
};

}  // namespace catena::render
