/// Buffers and images, each with its own memory (they are few). Move-only; destruction is retired to the device's timeline.
/// What the device's memory budget does not hold is refused with one sentence.
#pragma once
#include <vulkan/vulkan.h>

#include <span>

#include "render/vk/device.h"

namespace catena::render::vk {

/// Where a buffer lives: on the device, or on the host (mapped, coherent) for writing or for reading back.
enum class Memory { device, upload, readback };

/// A buffer with its memory. Frame thread.
class Buffer {
 public:
  Buffer() = default;
  /// Makes one. An error where the budget or the device has no memory.
  static Result<Buffer> create(Device& device, VkDeviceSize size, VkBufferUsageFlags usage, Memory memory);
  ~Buffer() { release(); }
  /// Takes the buffer over; `other` has none then.
  Buffer(Buffer&& other) noexcept { swap(other); }
  /// Exchanges the buffers.
  Buffer& operator=(Buffer&& other) noexcept {
    swap(other);
    return *this;
  }

  /// Vulkan's handle; null: there is none.
  VkBuffer handle() const { return buffer_; }
  /// Bytes.
  VkDeviceSize size() const { return size_; }
  /// Whether there is one.
  explicit operator bool() const { return buffer_ != VK_NULL_HANDLE; }
  /// Mapped bytes; empty on the device.
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

/// What an image is to be.
struct ImageInfo {
  VkImageType type = VK_IMAGE_TYPE_2D;         ///< 1D, 2D or 3D
  VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;  ///< of the texels
  VkExtent3D extent{1, 1, 1};                  ///< texels
  VkImageUsageFlags usage = 0;                 ///< as Vulkan's flags
};

/// Of three dimensions, uploaded once and read by shaders.
ImageInfo volume_image_info(VkFormat format, std::size_t x, std::size_t y, std::size_t z);

/// Bytes of one texel of the formats that Catena uses.
VkDeviceSize texel_bytes(VkFormat format);

/// What an image takes on this device, with the driver's padding; none where no such image can be made.
std::optional<VkDeviceSize> image_memory_bytes(const Device& device, const ImageInfo& info);

/// One mip level, one layer, one view. Remembers its layout and last use, so that a barrier needs only the next one.
class Image {
 public:
  Image() = default;
  /// Makes one. An error where the budget or the device has no memory.
  static Result<Image> create(Device& device, const ImageInfo& info);
  ~Image() { release(); }
  /// Takes the image over; `other` has none then.
  Image(Image&& other) noexcept { swap(other); }
  /// Exchanges the images.
  Image& operator=(Image&& other) noexcept {
    swap(other);
    return *this;
  }

  /// Vulkan's handle; null: there is none.
  VkImage handle() const { return image_; }
  /// Of all of it.
  VkImageView view() const { return view_; }
  /// What it was asked to be.
  const ImageInfo& info() const { return info_; }
  /// Device memory that it holds.
  VkDeviceSize bytes() const { return allocated_; }
  /// Colour or depth.
  VkImageAspectFlags aspect() const;
  /// Whether there is one.
  explicit operator bool() const { return image_ != VK_NULL_HANDLE; }

  // written by Commands::use, as recorded
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;        ///< that it is in once what was recorded has run
  VkPipelineStageFlags2 stage = VK_PIPELINE_STAGE_2_NONE;  ///< that used it last
  VkAccessFlags2 access = VK_ACCESS_2_NONE;                ///< how they used it

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

/// Makes `image` anew unless it has this format and size already; by default a colour target that shaders read.
Outcome ensure_image(Device& device, Image& image, VkFormat format, std::uint32_t width, std::uint32_t height,
                     VkImageUsageFlags usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);

/// Between texels: the nearest, or a mix.
enum class Filter { nearest, linear };

/// Clamped to the edge.
class Sampler {
 public:
  Sampler() = default;
  /// Makes one. An error is one sentence.
  static Result<Sampler> create(Device& device, Filter filter);
  ~Sampler();
  /// Takes the sampler over; `other` has none then.
  Sampler(Sampler&& other) noexcept : device_(other.device_), sampler_(other.sampler_) { other.sampler_ = VK_NULL_HANDLE; }
  /// Exchanges the samplers.
  Sampler& operator=(Sampler&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(sampler_, other.sampler_);
    return *this;
  }
  /// Vulkan's handle; null: there is none.
  VkSampler handle() const { return sampler_; }
  /// Whether there is one.
  explicit operator bool() const { return sampler_ != VK_NULL_HANDLE; }

 private:
  Device* device_ = nullptr;
  VkSampler sampler_ = VK_NULL_HANDLE;
};

}  // namespace catena::render::vk
