// SPDX-License-Identifier: MIT
#include "render/vk/resources.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/base/huge_pages.h"
#include "render/vk/instance.h"

namespace catena::render::vk {
namespace {

std::string megabytes(VkDeviceSize bytes) { return fmt::format("{:.1f} MB", 1e-6 * double(bytes)); }

/// Returns the first memory type that is allowed and has all `required` properties; one with `preferred` is chosen over others.
std::optional<std::uint32_t> memory_type(const Device& device, std::uint32_t allowed, VkMemoryPropertyFlags required,
                                         VkMemoryPropertyFlags preferred) {
  VkPhysicalDeviceMemoryProperties memory{};
  vkGetPhysicalDeviceMemoryProperties(device.physical(), &memory);
  for (const VkMemoryPropertyFlags wanted : {required | preferred, required})
    for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i)
      if ((allowed >> i & 1u) && (memory.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
  return std::nullopt;
}

Result<VkDeviceMemory> allocate(Device& device, const VkMemoryRequirements& needs, Memory where, const std::string& what) {
  constexpr VkMemoryPropertyFlags host = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  const auto type = where == Memory::device   ? memory_type(device, needs.memoryTypeBits, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)
                    : where == Memory::upload ? memory_type(device, needs.memoryTypeBits, host, 0)
                                              : memory_type(device, needs.memoryTypeBits, host, VK_MEMORY_PROPERTY_HOST_CACHED_BIT);
  if (!type) return Error{"the device " + device.info().name + " has no memory for " + what};
  DeviceCounters& counters = device.counters();
  if (needs.size > device.memory_available()) {
    ++counters.refused_allocations;
    return Error{fmt::format("{} needs {} of GPU memory, but only {} of the budget of {} is left", what, megabytes(needs.size),
                             megabytes(device.memory_available()), megabytes(device.info().memory_budget))};
  }
  VkMemoryAllocateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  info.allocationSize = needs.size;
  info.memoryTypeIndex = *type;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkResult result = device.injected_failure(DriverCall::allocate);
  if (result == VK_SUCCESS) result = vkAllocateMemory(device.handle(), &info, nullptr, &memory);
  if (result != VK_SUCCESS)
    return vulkan_error(result, fmt::format("allocate {} for {} ({} of {} in use)", megabytes(needs.size), what,
                                            megabytes(counters.allocated_bytes), megabytes(device.info().memory_bytes)));
  counters.allocated_bytes += needs.size;
  counters.peak_bytes = std::max(counters.peak_bytes, counters.allocated_bytes);
  ++counters.allocations;
  // a CPU driver uses the memory of the process
  if (void* start = nullptr; device.info().is_cpu() && needs.size >= kMinHugePageBytes &&
                             vkMapMemory(device.handle(), memory, 0, VK_WHOLE_SIZE, 0, &start) == VK_SUCCESS) {
    prefer_huge_pages(start, needs.size);
    vkUnmapMemory(device.handle(), memory);
  }
  return memory;
}

}  // namespace

Result<Buffer> Buffer::create(Device& device, VkDeviceSize size, VkBufferUsageFlags usage, Memory memory) {
  CATENA_ASSERT(size > 0);
  Buffer self;
  self.device_ = &device;
  self.size_ = size;
  VkBufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = size;
  info.usage = usage;
  CATENA_VK(vkCreateBuffer(device.handle(), &info, nullptr, &self.buffer_), "create a buffer of " + megabytes(size));
  VkMemoryRequirements needs{};
  vkGetBufferMemoryRequirements(device.handle(), self.buffer_, &needs);
  CATENA_TRY(self.memory_, allocate(device, needs, memory, "a buffer"));
  self.allocated_ = needs.size;
  CATENA_VK(vkBindBufferMemory(device.handle(), self.buffer_, self.memory_, 0), "bind a buffer's memory");
  if (memory != Memory::device) CATENA_VK(vkMapMemory(device.handle(), self.memory_, 0, VK_WHOLE_SIZE, 0, &self.mapped_), "map a buffer");
  return self;
}

void Buffer::swap(Buffer& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(buffer_, other.buffer_);
  std::swap(memory_, other.memory_);
  std::swap(size_, other.size_);
  std::swap(allocated_, other.allocated_);
  std::swap(mapped_, other.mapped_);
}

void Buffer::release() {
  if (!device_ || (!buffer_ && !memory_)) return;
  device_->retire([device = device_, buffer = buffer_, memory = memory_, bytes = memory_ ? allocated_ : 0] {
    vkDestroyBuffer(device->handle(), buffer, nullptr);
    vkFreeMemory(device->handle(), memory, nullptr);
    device->counters().allocated_bytes -= bytes;
  });
  buffer_ = VK_NULL_HANDLE;
  memory_ = VK_NULL_HANDLE;
}

VkDeviceSize texel_bytes(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R8_UINT:
    case VK_FORMAT_R8_UNORM:
      return 1;
    case VK_FORMAT_R16_SFLOAT:
    case VK_FORMAT_R16_UINT:
      return 2;
    case VK_FORMAT_R32_SFLOAT:
    case VK_FORMAT_R16G16_UINT:
    case VK_FORMAT_R32_UINT:
    case VK_FORMAT_D32_SFLOAT:
    case VK_FORMAT_R8G8B8A8_UNORM:
      return 4;
    case VK_FORMAT_R32G32_UINT:
    case VK_FORMAT_R16G16B16A16_SFLOAT:
    case VK_FORMAT_R16G16B16A16_UINT:
      return 8;
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return 16;
    default:
      CATENA_ASSERT(!"a format without a known size");
      return 0;
  }
}

VkImageAspectFlags Image::aspect() const {
  return info_.format == VK_FORMAT_D32_SFLOAT ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

namespace {

VkImageCreateInfo create_info(const ImageInfo& info) {
  VkImageCreateInfo create{};
  create.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  create.imageType = info.type;
  create.format = info.format;
  create.extent = info.extent;
  create.mipLevels = 1;
  create.arrayLayers = 1;
  create.samples = VK_SAMPLE_COUNT_1_BIT;
  create.tiling = VK_IMAGE_TILING_OPTIMAL;
  create.usage = info.usage;
  create.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
  return create;
}

}  // namespace

std::optional<VkDeviceSize> image_memory_bytes(const Device& device, const ImageInfo& info) {
  VkImageFormatProperties limits{};
  const auto& e = info.extent;
  if (vkGetPhysicalDeviceImageFormatProperties(device.physical(), info.format, info.type, VK_IMAGE_TILING_OPTIMAL, info.usage, 0,
                                               &limits) != VK_SUCCESS ||
      e.width > limits.maxExtent.width || e.height > limits.maxExtent.height || e.depth > limits.maxExtent.depth)
    return std::nullopt;
  const VkImageCreateInfo create = create_info(info);
  VkDeviceImageMemoryRequirements asked{};
  asked.sType = VK_STRUCTURE_TYPE_DEVICE_IMAGE_MEMORY_REQUIREMENTS;
  asked.pCreateInfo = &create;
  VkMemoryRequirements2 needs{};
  needs.sType = VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2;
  vkGetDeviceImageMemoryRequirements(device.handle(), &asked, &needs);
  return needs.memoryRequirements.size;
}

ImageInfo volume_image_info(VkFormat format, std::size_t x, std::size_t y, std::size_t z) {
  ImageInfo info;
  info.type = VK_IMAGE_TYPE_3D;
  info.format = format;
  info.extent = {std::uint32_t(x), std::uint32_t(y), std::uint32_t(z)};
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  return info;
}

Outcome ensure_image(Device& device, Image& image, VkFormat format, std::uint32_t width, std::uint32_t height, VkImageUsageFlags usage) {
  const VkExtent3D& have = image.info().extent;
  if (image && image.info().format == format && have.width == width && have.height == height) return Done{};
  ImageInfo info;
  info.format = format;
  info.extent = {width, height, 1};
  info.usage = usage;
  CATENA_TRY(image, Image::create(device, info));
  return Done{};
}

Result<Image> Image::create(Device& device, const ImageInfo& info) {
  // checks the device's limits, for an error message
  VkImageFormatProperties limits{};
  const VkResult supported =
      vkGetPhysicalDeviceImageFormatProperties(device.physical(), info.format, info.type, VK_IMAGE_TILING_OPTIMAL, info.usage, 0, &limits);
  const auto& e = info.extent;
  if (supported != VK_SUCCESS || e.width > limits.maxExtent.width || e.height > limits.maxExtent.height || e.depth > limits.maxExtent.depth)
    return Error{fmt::format("an image of {} x {} x {} is too large for the device {}, expected at most {} x {} x {}", e.width, e.height,
                             e.depth, device.info().name, limits.maxExtent.width, limits.maxExtent.height, limits.maxExtent.depth)};

  Image self;
  self.device_ = &device;
  self.info_ = info;
  const VkImageCreateInfo create = create_info(info);
  const std::string what = fmt::format("an image of {} x {} x {}", e.width, e.height, e.depth);
  CATENA_VK(vkCreateImage(device.handle(), &create, nullptr, &self.image_), "create " + what);
  VkMemoryRequirements needs{};
  vkGetImageMemoryRequirements(device.handle(), self.image_, &needs);
  CATENA_TRY(self.memory_, allocate(device, needs, Memory::device, what));
  self.allocated_ = needs.size;
  CATENA_VK(vkBindImageMemory(device.handle(), self.image_, self.memory_, 0), "bind the memory of " + what);

  VkImageViewCreateInfo view{};
  view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  view.image = self.image_;
  view.viewType = info.type == VK_IMAGE_TYPE_3D ? VK_IMAGE_VIEW_TYPE_3D : VK_IMAGE_VIEW_TYPE_2D;
  view.format = info.format;
  view.subresourceRange = {self.aspect(), 0, 1, 0, 1};
  CATENA_VK(vkCreateImageView(device.handle(), &view, nullptr, &self.view_), "create a view of " + what);
  return self;
}

void Image::swap(Image& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(image_, other.image_);
  std::swap(view_, other.view_);
  std::swap(memory_, other.memory_);
  std::swap(allocated_, other.allocated_);
  std::swap(info_, other.info_);
  std::swap(layout, other.layout);
  std::swap(stage, other.stage);
  std::swap(access, other.access);
}

void Image::release() {
  if (!device_ || (!image_ && !memory_)) return;
  device_->retire([device = device_, image = image_, view = view_, memory = memory_, bytes = memory_ ? allocated_ : 0] {
    vkDestroyImageView(device->handle(), view, nullptr);
    vkDestroyImage(device->handle(), image, nullptr);
    vkFreeMemory(device->handle(), memory, nullptr);
    device->counters().allocated_bytes -= bytes;
  });
  image_ = VK_NULL_HANDLE;
  view_ = VK_NULL_HANDLE;
  memory_ = VK_NULL_HANDLE;
}

Result<Sampler> Sampler::create(Device& device, Filter filter) {
  const bool linear = filter == Filter::linear;
  VkSamplerCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
  info.magFilter = info.minFilter = linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
  info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_NEAREST;
  info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  Sampler self;
  self.device_ = &device;
  CATENA_VK(vkCreateSampler(device.handle(), &info, nullptr, &self.sampler_), "create a sampler");
  return self;
}

Sampler::~Sampler() {
  if (sampler_) device_->retire([device = device_, sampler = sampler_] { vkDestroySampler(device->handle(), sampler, nullptr); });
}

}  // namespace catena::render::vk
