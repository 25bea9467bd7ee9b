// SPDX-License-Identifier: MIT
/// Pipelines from SPIR-V words embedded at build time, or from their replacements (ShaderReplacements). Descriptors are pushed; shader
/// constants are specialized.
#pragma once
#include <vulkan/vulkan.h>

#include <span>
#include <vector>

#include "render/vk/device.h"

namespace catena::render::vk {

/// Kind of a shader binding.
enum class DescriptorKind {
  uniform,
  buffer,
  sampled,
  texture,
  storage_image
};  ///< sampled: image with a sampler; texture: texel fetches only
/// Returns the Vulkan descriptor type.
VkDescriptorType descriptor_type(DescriptorKind resource);
/// Binding of the image that all pipelines share (Device::share), with a sampler.
inline constexpr std::uint32_t kSharedBinding = 63;
/// Binding number and kind in a pipeline layout.
struct LayoutBinding {
  std::uint32_t binding = 0;
  DescriptorKind kind = DescriptorKind::buffer;
};

/// Attribute of the vertex buffer.
struct VertexAttribute {
  std::uint32_t location = 0;
  VkFormat format = VK_FORMAT_R32G32B32_SFLOAT;
  std::uint32_t offset = 0;
};

/// Blending of a fragment with a color target.
enum class Blend {
  replace,
  over,           ///< source over destination, premultiplied colors
  over_straight,  ///< source over destination, straight alpha
  keep,           ///< nothing is written
  accumulate,     ///< rgb <- rgb + source; alpha <- alpha (1 - source)
  min,            ///< minimum of both
};

/// Description of a graphics pipeline.
struct GraphicsInfo {
  Spirv vertex, fragment;
  std::vector<LayoutBinding> layout_bindings;
  std::vector<std::uint32_t> constants;  ///< specialization constants 0, 1, 2, .. of the fragment shader
  std::vector<VkFormat> colors;
  std::vector<Blend> blends{};      ///< one per color target; empty: replace
  bool has_depth = false;           ///< depth buffer D32F, reversed: greater is nearer
  std::uint32_t vertex_stride = 0;  ///< 0: no vertex buffer
  std::vector<VertexAttribute> attributes;
};

/// Description of a compute pipeline.
struct ComputeInfo {
  Spirv shader;
  std::vector<LayoutBinding> layout_bindings;
  std::vector<std::uint32_t> constants;
};

/// Graphics or compute pipeline with its layout. Move-only; destruction is retired to the device's timeline. Frame thread.
class Pipeline {
 public:
  Pipeline() = default;
  /// Creates the pipeline. An Error if the driver refuses.
  static Result<Pipeline> create(Device& device, const GraphicsInfo& info);
  static Result<Pipeline> create(Device& device, const ComputeInfo& info);
  ~Pipeline();
  Pipeline(Pipeline&& other) noexcept { swap(other); }
  Pipeline& operator=(Pipeline&& other) noexcept {
    swap(other);
    return *this;
  }

  VkPipeline handle() const { return pipeline_; }
  VkPipelineLayout layout() const { return layout_; }
  VkPipelineBindPoint bind_point() const { return bind_point_; }
  /// Returns whether its layout has kSharedBinding.
  bool uses_shared_image() const { return uses_shared_image_; }
  explicit operator bool() const { return pipeline_ != VK_NULL_HANDLE; }

 private:
  void swap(Pipeline& other) noexcept;
  Outcome create_layout(std::span<const LayoutBinding> slots, VkShaderStageFlags stages);
  Device* device_ = nullptr;
  VkDescriptorSetLayout set_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
  VkPipelineBindPoint bind_point_ = VK_PIPELINE_BIND_POINT_GRAPHICS;
  bool uses_shared_image_ = false;
};

}  // namespace catena::render::vk
