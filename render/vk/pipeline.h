/// Pipelines from SPIR-V words that were embedded at build time, or from what the device has in their place. Descriptors are pushed; shader
/// constants are specialised.
#pragma once
#include <vulkan/vulkan.h>

#include <span>
#include <vector>

#include "render/vk/device.h"

namespace catena::render::vk {

/// One binding of a shader: what kind it is.
enum class DescriptorKind { uniform, buffer, sampled, texture, storage_image };  ///< sampled: with a sampler; texture: fetched only
VkDescriptorType descriptor_type(DescriptorKind resource);
struct LayoutBinding {
  std::uint32_t binding = 0;
  DescriptorKind kind = DescriptorKind::buffer;
};

struct VertexAttribute {
  std::uint32_t location = 0;
  VkFormat format = VK_FORMAT_R32G32B32_SFLOAT;
  std::uint32_t offset = 0;
};

/// What becomes of a colour target's texel.
enum class Blend {
  replace,
  over,           ///< premultiplied colours over what is there
  over_straight,  ///< the same for straight alpha
  keep,           ///< nothing is written
  accumulate,     ///< rgb <- rgb + source; alpha <- alpha (1 - source)
  min,            ///< the lesser of both
};

struct GraphicsInfo {
  Spirv vertex, fragment;
  std::vector<LayoutBinding> layout_bindings;
  std::vector<std::uint32_t> constants;  ///< specialisation constants 0, 1, 2, .. of the fragment shader
  std::vector<VkFormat> colors;
  std::vector<Blend> blends{};      ///< by colour; empty: replace
  bool has_depth = false;           ///< D32F, reversed: greater is nearer
  std::uint32_t vertex_stride = 0;  ///< 0: no vertex buffer
  std::vector<VertexAttribute> attributes;
};

struct ComputeInfo {
  Spirv shader;
  std::vector<LayoutBinding> layout_bindings;
  std::vector<std::uint32_t> constants;
};

class Pipeline {
 public:
  Pipeline() = default;
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
  explicit operator bool() const { return pipeline_ != VK_NULL_HANDLE; }

 private:
  void swap(Pipeline& other) noexcept;
  Outcome create_layout(std::span<const LayoutBinding> slots, VkShaderStageFlags stages);
  Device* device_ = nullptr;
  VkDescriptorSetLayout set_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
  VkPipelineBindPoint bind_point_ = VK_PIPELINE_BIND_POINT_GRAPHICS;
};

}  // namespace catena::render::vk
