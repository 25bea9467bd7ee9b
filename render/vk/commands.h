/// One recording of work: barriers, copies, passes. Submitted once; its command buffer is retired to the timeline.
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

/// A use of an image or a buffer, for barriers.
struct ResourceUse {
  VkImageLayout layout;  ///< images
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

struct ColorTarget {
  Image* image = nullptr;
  std::optional<std::array<float, 4>> clear;  ///< none: keep what is there
};
struct DepthTarget {
  Image* image = nullptr;
  std::optional<float> clear;
};

/// What a shader sees at one binding; which members count is the kind's business.
struct Binding {
  std::uint32_t binding = 0;
  DescriptorKind kind = DescriptorKind::buffer;
  const Buffer* buffer = nullptr;
  const Image* image = nullptr;
  const Sampler* sampler = nullptr;
};

class Commands {
 public:
  static Result<Commands> begin(Device& device);
  ~Commands();
  Commands(Commands&& other) noexcept : device_(other.device_), buffer_(other.buffer_), timestamp_(other.timestamp_) {
    other.buffer_ = VK_NULL_HANDLE;
    other.timestamp_.reset();
  }
  Commands& operator=(Commands&&) = delete;

  VkCommandBuffer handle() const { return buffer_; }

  // barriers
  void transition(Image& image, const ResourceUse& next);
  void barrier(const Buffer& buffer, const ResourceUse& from, const ResourceUse& to);
  void barrier(VkImage image, VkImageAspectFlags aspect, const ResourceUse& from, const ResourceUse& to);  ///< of an image that others own

  // copies
  void copy(const Buffer& from, VkDeviceSize offset, Image& to, VkOffset3D at, VkExtent3D extent);  ///< an upload; counted
  void copy(const Buffer& from, const Buffer& to, VkDeviceSize size);                               ///< an upload; counted
  void copy(Image& from, const Buffer& to);                                                         ///< a read-back
  /// All of an image over all of another, scaled (linear); the layouts are TRANSFER_SRC and TRANSFER_DST.
  void blit(const Image& from, const Image& to);
  void blit(const Image& from, VkImage to, VkExtent2D extent);

  // passes
  /// Moves the targets to their layouts. Draws and clears within `area`, which is not empty; none: everywhere.
  void begin_pass(std::span<const ColorTarget> colors, const DepthTarget& depth, const std::optional<VkRect2D>& area = {});
  void end_pass();
  void set_scissor(const VkRect2D& area);
  void bind(const Pipeline& pipeline, std::span<const Binding> bindings);
  void draw_triangle();                                        ///< one that covers the picture
  void draw(std::uint32_t vertices, std::uint32_t instances);  ///< without buffers
  void draw_indexed(const Buffer& vertices, const Buffer& indices, std::uint32_t index_count);
  void bind_indices(const Buffer& indices, VkIndexType type);  ///< of a pipeline without a vertex buffer
  void bind_mesh(const Buffer& vertices, const Buffer& indices, VkIndexType type);
  /// Of the bound mesh; indices count from `first_vertex` on. `instance`: its number for the shader.
  void draw_mesh(std::uint32_t first_index, std::uint32_t index_count, std::uint32_t first_vertex, std::uint32_t instance = 0);
  void dispatch(std::uint32_t x, std::uint32_t y, std::uint32_t z);

  /// Ends and submits; the value of the timeline when it is done.
  Result<std::uint64_t> submit(VkSemaphore wait = VK_NULL_HANDLE, VkSemaphore signal = VK_NULL_HANDLE);
  /// submit() and wait for it.
  Outcome finish();

 private:
  Commands(Device& device, VkCommandBuffer buffer) : device_(&device), buffer_(buffer) {}
  Device* device_;
  VkCommandBuffer buffer_;
  TimestampQueries::TimestampPair timestamp_;
};

// ---- bytes to the device: through staging memory what changes seldom (these wait for their own end), mapped what changes each frame ----

/// Fills `image` in pieces of whole z-ranges: fill(first_z, count_z, bytes) writes the texels x fastest. `granule` z-planes stay
/// together. Ends with the image ready for shaders.
Outcome upload_planes(Device& device, Image& image, std::uint32_t granule,
                      const std::function<void(std::uint32_t first, std::uint32_t count, std::byte* out)>& fill);

/// A device buffer with these bytes (at least one).
Result<Buffer> upload_buffer(Device& device, std::span<const std::byte> bytes, VkBufferUsageFlags usage);

/// Host memory with these items; with room for twice as many where it must grow.
template <class T>
Outcome write_items(Device& device, Buffer& buffer, const std::vector<T>& items, VkBufferUsageFlags usage) {
  const std::size_t bytes = std::max<std::size_t>(1, items.size()) * sizeof(T);
  if (!buffer || buffer.size() < bytes) {
    CATENA_TRY(buffer, Buffer::create(device, 2 * bytes, usage, Memory::upload));
  }
  if (!items.empty()) std::memcpy(buffer.bytes().data(), items.data(), items.size() * sizeof(T));
  return Done{};
}

/// A uniform buffer that the host writes each frame.
template <class Data>
Outcome write_uniform(Device& device, Buffer& buffer, const Data& data) {
  if (!buffer) {
    CATENA_TRY(buffer, Buffer::create(device, sizeof(Data), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, Memory::upload));
  }
  std::memcpy(buffer.bytes().data(), &data, sizeof(Data));
  return Done{};
}

}  // namespace catena::render::vk
