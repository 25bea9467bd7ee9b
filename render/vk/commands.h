// SPDX-License-Identifier: MIT
/// Recording of GPU work: barriers, copies, render passes. Submitted once; its command buffer is retired to the timeline. Frame thread.
#pragma once
#include <vulkan/vulkan.h>

#include <array>
#include <cstring>
#include <functional>
#include <optional>
#include <span>

#include "render/vk/pipeline.h"
#include "render/vk/resources.h"
#include "render/vk/timestamp_query.h"

namespace catena::render::vk {

/// Use of an image or a buffer, for barriers.
struct ResourceUse {
  VkImageLayout layout;  ///< images only
  VkPipelineStageFlags2 stage;
  VkAccessFlags2 access;
};
inline constexpr ResourceUse kTransferWrite{VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                            VK_ACCESS_2_TRANSFER_WRITE_BIT};
inline constexpr ResourceUse kTransferRead{VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                           VK_ACCESS_2_TRANSFER_READ_BIT};
inline constexpr ResourceUse kFragmentRead{VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                           VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                           VK_ACCESS_2_SHADER_READ_BIT};
inline constexpr ResourceUse kShaderRead{
    VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
    VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
    VK_ACCESS_2_SHADER_READ_BIT};
inline constexpr ResourceUse kVertexRead{VK_IMAGE_LAYOUT_UNDEFINED,
                                         VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT | VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT,
                                         VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT | VK_ACCESS_2_INDEX_READ_BIT};
inline constexpr ResourceUse kComputeWrite{VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_WRITE_BIT};
inline constexpr ResourceUse kHostRead{VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT};
inline constexpr ResourceUse kColorTarget{VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                          VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
inline constexpr ResourceUse kDepthTarget{VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                                          VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
                                          VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};

/// Color attachment of a render pass.
struct ColorTarget {
  Image* image = nullptr;
  std::optional<std::array<float, 4>> clear;  ///< clear color; nullopt: the content is kept
};
/// Depth attachment of a render pass; `image` null: none. `clear` nullopt: the content is kept.
struct DepthTarget {
  Image* image = nullptr;
  std::optional<float> clear;
};

/// Resource bound to a shader binding; which members are used depends on the kind.
struct Binding {
  std::uint32_t binding = 0;
  DescriptorKind kind = DescriptorKind::buffer;
  const Buffer* buffer = nullptr;
  const Image* image = nullptr;
  const Sampler* sampler = nullptr;
};

/// Command buffer in the recording state. If it is destroyed without submit(), its commands are discarded.
class Commands {
 public:
  /// Begins recording. An Error if the driver refuses.
  static Result<Commands> begin(Device& device);
  ~Commands();
  Commands(Commands&& other) noexcept : device_(other.device_), buffer_(other.buffer_), timestamp_(other.timestamp_) {
    other.buffer_ = VK_NULL_HANDLE;
    other.timestamp_.reset();
  }
  Commands& operator=(Commands&&) = delete;

  VkCommandBuffer handle() const { return buffer_; }

  // barriers
  /// Records a barrier from the image's last use to `next`, including the layout transition.
  void transition(Image& image, const ResourceUse& next);
  /// Records a barrier between two uses of a buffer.
  void barrier(const Buffer& buffer, const ResourceUse& from, const ResourceUse& to);
  void barrier(VkImage image, VkImageAspectFlags aspect, const ResourceUse& from, const ResourceUse& to);  ///< for an image owned by others

  // copies
  void copy(const Buffer& from, VkDeviceSize offset, Image& to, VkOffset3D at, VkExtent3D extent);  ///< upload; counted
  void copy(const Buffer& from, const Buffer& to, VkDeviceSize size);                               ///< upload; counted
  void copy(Image& from, const Buffer& to);                                                         ///< read-back
  /// Copies the whole image over another whole image, scaled (linear filter); the layouts must be TRANSFER_SRC and TRANSFER_DST.
  void blit(const Image& from, const Image& to);
  /// Copies the whole image over an image owned by others, scaled.
  void blit(const Image& from, VkImage to, VkExtent2D extent);

  // render passes
  /// Begins a render pass and transitions the targets to their layouts. Rendering and clearing are limited to `area`, which must not be
  /// empty; nullopt: everywhere.
  void begin_pass(std::span<const ColorTarget> colors, const DepthTarget& depth, const std::optional<VkRect2D>& area = {});
  void end_pass();
  void set_scissor(const VkRect2D& area);
  /// Binds a pipeline and pushes its descriptors.
  void bind(const Pipeline& pipeline, std::span<const Binding> own);
  void draw_triangle();                                        ///< one triangle that covers the image
  void draw(std::uint32_t vertices, std::uint32_t instances);  ///< without buffers
  void draw_indexed(const Buffer& vertices, const Buffer& indices, std::uint32_t index_count);
  void bind_indices(const Buffer& indices, VkIndexType type);  ///< for a pipeline without a vertex buffer
  /// Binds buffers for draw_mesh().
  void bind_mesh(const Buffer& vertices, const Buffer& indices, VkIndexType type);
  /// Draws from the bound mesh; indices are relative to `first_vertex`. `instance`: instance index in the shader.
  void draw_mesh(std::uint32_t first_index, std::uint32_t index_count, std::uint32_t first_vertex, std::uint32_t instance = 0);
  void dispatch(std::uint32_t x, std::uint32_t y, std::uint32_t z);

  /// Ends recording and submits; returns the timeline value that is reached when the work is done. `wait`, `signal`: binary semaphores.
  Result<std::uint64_t> submit(VkSemaphore wait = VK_NULL_HANDLE, VkSemaphore signal = VK_NULL_HANDLE);
  /// Submits and waits until the work is done.
  Outcome finish();

 private:
  Commands(Device& device, VkCommandBuffer buffer) : device_(&device), buffer_(buffer) {}
  Device* device_;
  VkCommandBuffer buffer_;
  TimestampQueries::TimestampPair timestamp_;
};

// Transfer of data to the device: through staging memory for data that changes rarely (these functions wait for completion), through mapped
// memory for data that changes every frame.

/// Uploads `image` in chunks of whole z-planes: fill(first_z, count_z, bytes) writes the texels, x fastest. Chunks are multiples of
/// `granule` planes. Leaves the image ready for shaders.
Outcome upload_planes(Device& device, Image& image, std::uint32_t granule,
                      const std::function<void(std::uint32_t first, std::uint32_t count, std::byte* out)>& fill);

/// Creates a device buffer with these bytes (at least one).
Result<Buffer> upload_buffer(Device& device, std::span<const std::byte> bytes, VkBufferUsageFlags usage);

/// Writes the items to a host-visible buffer; if it is too small, it is re-created with twice the size needed.
template <class T>
Outcome write_items(Device& device, Buffer& buffer, const std::vector<T>& items, VkBufferUsageFlags usage) {
  const std::size_t bytes = std::max<std::size_t>(1, items.size()) * sizeof(T);
  if (!buffer || buffer.size() < bytes) {
    CATENA_TRY(buffer, Buffer::create(device, 2 * bytes, usage, Memory::upload));
  }
  if (!items.empty()) std::memcpy(buffer.bytes().data(), items.data(), items.size() * sizeof(T));
  return Done{};
}

/// Writes a uniform buffer that the host updates every frame; creates it on first use.
template <class Data>
Outcome write_uniform(Device& device, Buffer& buffer, const Data& data) {
  if (!buffer) {
    CATENA_TRY(buffer, Buffer::create(device, sizeof(Data), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, Memory::upload));
  }
  std::memcpy(buffer.bytes().data(), &data, sizeof(Data));
  return Done{};
}

}  // namespace catena::render::vk
