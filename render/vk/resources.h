// SPDX-License-Identifier: MIT
/// Buffers and images, each with its own memory allocation (there are few). Move-only; destruction is retired to the device's timeline.
/// Allocations beyond the device's memory budget fail with a one-line Error.
#pragma once
#include <vulkan/vulkan.h>

#include <span>

#include "engine/base/export.h"
#include "render/vk/device.h"

namespace catena::render::vk {

/// Memory of a buffer: on the device, or on the host (mapped, coherent) for writing or for reading back.
enum class Memory { device, upload, readback };

/// Buffer with its memory. Frame thread.
class CATENA_EXPORT Buffer {
 public:
  Buffer() = default;
  /// Creates a buffer. An Error if the budget or the device has no memory.
  static Result<Buffer> create(Device& device, VkDeviceSize size, VkBufferUsageFlags usage, Memory memory);
  ~Buffer() { release(); }
  /// Moves the buffer; `other` is empty afterwards.
  Buffer(Buffer&& other) noexcept { swap(other); }
  /// Swaps the buffers.
  Buffer& operator=(Buffer&& other) noexcept {
    swap(other);
    return *this;
  }

  /// Returns the Vulkan handle; null if empty.
  VkBuffer handle() const { return buffer_; }
  /// Returns the size in bytes; 0 if empty.
  VkDeviceSize size() const { return size_; }
  /// Returns whether the buffer is not empty.
  explicit operator bool() const { return buffer_ != VK_NULL_HANDLE; }
  /// Returns the mapped bytes; empty for device memory.
  std::span<std::byte> bytes() const { return {static_cast<std::byte*>(mapped_), mapped_ ? std::size_t(size_) : 0}; }

 private:
  void swap(Buffer& other) noexcept;
  void release();
  Device* device_ = nullptr;
  VkBuffer buffer_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  VkDeviceSize size_ = 0, allocated_ = 0;
  void* mapped_ = nullptr;
};

/// Parameters for creating an image.
struct ImageInfo {
  VkImageType type = VK_IMAGE_TYPE_2D;         ///< 1D, 2D or 3D
  VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;  ///< texel format
  VkExtent3D extent{1, 1, 1};                  ///< texels
  VkImageUsageFlags usage = 0;                 ///< Vulkan usage flags
};

/// Returns the parameters of a 3D image that is uploaded once and read by shaders.
CATENA_EXPORT ImageInfo volume_image_info(VkFormat format, std::size_t x, std::size_t y, std::size_t z);

/// Returns the bytes per texel of the formats that Catena uses.
CATENA_EXPORT VkDeviceSize texel_bytes(VkFormat format);

/// Returns the memory size of an image on this device, including padding by the driver; nullopt if the image is not supported.
CATENA_EXPORT std::optional<VkDeviceSize> image_memory_bytes(const Device& device, const ImageInfo& info);

/// Image with its memory: one mip level, one layer, one view. Tracks its layout and last use, so that a barrier needs only the next use.
class CATENA_EXPORT Image {
 public:
  Image() = default;
  /// Creates an image. An Error if the budget or the device has no memory.
  static Result<Image> create(Device& device, const ImageInfo& info);
  ~Image() { release(); }
  /// Moves the image; `other` is empty afterwards.
  Image(Image&& other) noexcept { swap(other); }
  /// Swaps the images.
  Image& operator=(Image&& other) noexcept {
    swap(other);
    return *this;
  }

  /// Returns the Vulkan handle; null if empty.
  VkImage handle() const { return image_; }
  /// Returns the view of the whole image.
  VkImageView view() const { return view_; }
  /// Returns the creation parameters.
  const ImageInfo& info() const { return info_; }
  /// Returns the size of its device memory, bytes.
  VkDeviceSize bytes() const { return allocated_; }
  /// Returns the color or the depth aspect.
  VkImageAspectFlags aspect() const;
  /// Returns whether the image is not empty.
  explicit operator bool() const { return image_ != VK_NULL_HANDLE; }

  // State of the last recorded use, maintained by Commands.
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;        ///< layout after the recorded commands have run
  VkPipelineStageFlags2 stage = VK_PIPELINE_STAGE_2_NONE;  ///< stages of the last use
  VkAccessFlags2 access = VK_ACCESS_2_NONE;                ///< accesses of the last use

 private:
  void swap(Image& other) noexcept;
  void release();
  Device* device_ = nullptr;
  VkImage image_ = VK_NULL_HANDLE;
  VkImageView view_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  VkDeviceSize allocated_ = 0;
  ImageInfo info_;
};

/// Re-creates `image` unless it has this format and size; by default as a color target that shaders read.
CATENA_EXPORT Outcome ensure_image(Device& device, Image& image, VkFormat format, std::uint32_t width, std::uint32_t height,
                                   VkImageUsageFlags usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);

/// Filter between texels: nearest texel or linear interpolation.
enum class Filter { nearest, linear };

/// Sampler that clamps to the edge. Move-only.
class CATENA_EXPORT Sampler {
 public:
  Sampler() = default;
  /// Creates a sampler. A one-line Error if the driver refuses.
  static Result<Sampler> create(Device& device, Filter filter);
  ~Sampler();
  /// Moves the sampler; `other` is empty afterwards.
  Sampler(Sampler&& other) noexcept : device_(other.device_), sampler_(other.sampler_) { other.sampler_ = VK_NULL_HANDLE; }
  /// Swaps the samplers.
  Sampler& operator=(Sampler&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(sampler_, other.sampler_);
    return *this;
  }
  /// Returns the Vulkan handle; null if empty.
  VkSampler handle() const { return sampler_; }
  /// Returns whether the sampler is not empty.
  explicit operator bool() const { return sampler_ != VK_NULL_HANDLE; }

 private:
  Device* device_ = nullptr;
  VkSampler sampler_ = VK_NULL_HANDLE;
};

}  // namespace catena::render::vk
