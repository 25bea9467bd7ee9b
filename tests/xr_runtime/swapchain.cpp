// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>

#include "tests/xr_runtime/runtime.h"

namespace catena::test::xr_runtime {

namespace {

std::uint32_t memory_type(VkPhysicalDevice physical, std::uint32_t bits, VkMemoryPropertyFlags wanted) {
  VkPhysicalDeviceMemoryProperties properties{};
  vkGetPhysicalDeviceMemoryProperties(physical, &properties);
  for (std::uint32_t i = 0; i < properties.memoryTypeCount; ++i)
    if ((bits >> i & 1) && (properties.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
  return 0;
}

/// Records a command buffer, submits it and waits for it.
template <class Record_>
void run(SessionObject& session, const Record_& record) {
  VkCommandPoolCreateInfo pool_info{};
  pool_info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
  pool_info.queueFamilyIndex = session.family;
  VkCommandPool pool = VK_NULL_HANDLE;
  vkCreateCommandPool(session.device, &pool_info, nullptr, &pool);
  VkCommandBufferAllocateInfo allocate{};
  allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
  allocate.commandPool = pool;
  allocate.commandBufferCount = 1;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  vkAllocateCommandBuffers(session.device, &allocate, &commands);
  VkCommandBufferBeginInfo begin{};
  begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  vkBeginCommandBuffer(commands, &begin);
  record(commands);
  vkEndCommandBuffer(commands);
  VkSubmitInfo submit{};
  submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands;
  vkQueueSubmit(session.queue, 1, &submit, VK_NULL_HANDLE);
  vkQueueWaitIdle(session.queue);
  vkDestroyCommandPool(session.device, pool, nullptr);
}

void barrier(VkCommandBuffer commands, VkImage image, bool depth, VkImageLayout from, VkImageLayout to) {
  VkImageMemoryBarrier move{};
  move.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
  move.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
  move.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  move.oldLayout = from;
  move.newLayout = to;
  move.srcQueueFamilyIndex = move.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  move.image = image;
  move.subresourceRange = {VkImageAspectFlags(depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT), 0, 1, 0, 1};
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr, 1,
                       &move);
}

VkImageLayout lent_layout(const SwapchainObject& swapchain) {
  return swapchain.is_depth() ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
}

XRAPI_ATTR XrResult XRAPI_CALL swapchain_formats(XrSession handle, std::uint32_t capacity, std::uint32_t* count, std::int64_t* out) {
  ENTER(xrEnumerateSwapchainFormats);
  FIND(SessionObject, session, handle, session);
  return fill(world().shared.script.formats, capacity, count, out);
}

XRAPI_ATTR XrResult XRAPI_CALL create_swapchain(XrSession handle, const XrSwapchainCreateInfo* info, XrSwapchain* made) {
  ENTER(xrCreateSwapchain);
  FIND(SessionObject, session, handle, session);
  const auto& formats = world().shared.script.formats;
  if (std::ranges::find(formats, info->format) == formats.end())
    return illegal(self, XR_ERROR_SWAPCHAIN_FORMAT_UNSUPPORTED, "a format that is not offered");
  auto swapchain = std::make_unique<SwapchainObject>(number(handle));
  swapchain->device = session->device;
  swapchain->info = *info;
  const bool depth = swapchain->is_depth();
  for (std::uint32_t i = 0; i < world().shared.script.images; ++i) {
    VkImageCreateInfo image{};
    image.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    image.imageType = VK_IMAGE_TYPE_2D;
    image.format = VkFormat(info->format);
    image.extent = {info->width, info->height, 1};
    image.mipLevels = image.arrayLayers = 1;
    image.samples = VK_SAMPLE_COUNT_1_BIT;
    image.usage =
        VK_IMAGE_USAGE_TRANSFER_SRC_BIT | (depth ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    if (info->usageFlags & XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT) image.usage |= VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    if (info->usageFlags & XR_SWAPCHAIN_USAGE_SAMPLED_BIT) image.usage |= VK_IMAGE_USAGE_SAMPLED_BIT;
    VkImage made_image = VK_NULL_HANDLE;
    if (vkCreateImage(session->device, &image, nullptr, &made_image) != VK_SUCCESS) return XR_ERROR_OUT_OF_MEMORY;
    swapchain->images.push_back(made_image);
    VkMemoryRequirements needs{};
    vkGetImageMemoryRequirements(session->device, made_image, &needs);
    VkMemoryAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    allocate.allocationSize = needs.size;
    allocate.memoryTypeIndex = memory_type(session->physical, needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    VkDeviceMemory memory = VK_NULL_HANDLE;
    if (vkAllocateMemory(session->device, &allocate, nullptr, &memory) != VK_SUCCESS) return XR_ERROR_OUT_OF_MEMORY;
    swapchain->memory.push_back(memory);
    vkBindImageMemory(session->device, made_image, memory, 0);
    run(*session,
        [&](VkCommandBuffer commands) { barrier(commands, made_image, depth, VK_IMAGE_LAYOUT_UNDEFINED, lent_layout(*swapchain)); });
  }
  *made = as_handle<XrSwapchain>(world().add(std::move(swapchain)));
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL destroy_swapchain(XrSwapchain handle) {
  ENTER_TO_DESTROY(xrDestroySwapchain);
  FIND(SwapchainObject, swapchain, handle, swapchain);
  world().remove(number(handle));
  return answer;
}

XRAPI_ATTR XrResult XRAPI_CALL swapchain_images(XrSwapchain handle, std::uint32_t capacity, std::uint32_t* count,
                                                XrSwapchainImageBaseHeader* out) {
  ENTER(xrEnumerateSwapchainImages);
  FIND(SwapchainObject, swapchain, handle, swapchain);
  *count = std::uint32_t(swapchain->images.size());
  if (capacity == 0) return XR_SUCCESS;
  if (capacity < *count) return XR_ERROR_SIZE_INSUFFICIENT;
  auto* images = reinterpret_cast<XrSwapchainImageVulkan2KHR*>(out);
  for (std::uint32_t i = 0; i < *count; ++i) images[i].image = swapchain->images[i];
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL acquire(XrSwapchain handle, const XrSwapchainImageAcquireInfo*, std::uint32_t* index) {
  ENTER(xrAcquireSwapchainImage);
  FIND(SwapchainObject, swapchain, handle, swapchain);
  if (swapchain->acquired.size() == swapchain->images.size()) return illegal(self, XR_ERROR_CALL_ORDER_INVALID, "all images are lent");
  *index = swapchain->next++ % std::uint32_t(swapchain->images.size());
  swapchain->acquired.push_back(*index);
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL wait_image(XrSwapchain handle, const XrSwapchainImageWaitInfo*) {
  ENTER(xrWaitSwapchainImage);
  FIND(SwapchainObject, swapchain, handle, swapchain);
  if (swapchain->acquired.empty() || swapchain->waited) return illegal(self, XR_ERROR_CALL_ORDER_INVALID, "no image to wait for");
  swapchain->waited = true;
  return XR_SUCCESS;
}

XRAPI_ATTR XrResult XRAPI_CALL release(XrSwapchain handle, const XrSwapchainImageReleaseInfo*) {
  ENTER(xrReleaseSwapchainImage);
  FIND(SwapchainObject, swapchain, handle, swapchain);
  if (!swapchain->waited) return illegal(self, XR_ERROR_CALL_ORDER_INVALID, "no image was waited for");
  swapchain->waited = false;
  swapchain->released = swapchain->acquired.front();
  swapchain->acquired.pop_front();
  return XR_SUCCESS;
}

}  // namespace

SwapchainObject::~SwapchainObject() {
  for (VkImage image : images) vkDestroyImage(device, image, nullptr);
  for (VkDeviceMemory one : memory) vkFreeMemory(device, one, nullptr);
}

void read_back(SessionObject& session, SwapchainObject& swapchain, const XrRect2Di& rect, CapturedImage& captured) {
  const auto width = std::uint32_t(rect.extent.width), height = std::uint32_t(rect.extent.height);
  const VkDeviceSize bytes = VkDeviceSize(4) * width * height;
  VkBufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = bytes;
  info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  VkBuffer buffer = VK_NULL_HANDLE;
  vkCreateBuffer(session.device, &info, nullptr, &buffer);
  VkMemoryRequirements needs{};
  vkGetBufferMemoryRequirements(session.device, buffer, &needs);
  VkMemoryAllocateInfo allocate{};
  allocate.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  allocate.allocationSize = needs.size;
  allocate.memoryTypeIndex =
      memory_type(session.physical, needs.memoryTypeBits, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  VkDeviceMemory memory = VK_NULL_HANDLE;
  vkAllocateMemory(session.device, &allocate, nullptr, &memory);
  vkBindBufferMemory(session.device, buffer, memory, 0);
  VkImage image = swapchain.images[*swapchain.released];
  const bool depth = swapchain.is_depth();
  run(session, [&](VkCommandBuffer commands) {
    barrier(commands, image, depth, lent_layout(swapchain), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    VkBufferImageCopy region{};
    region.imageSubresource = {VkImageAspectFlags(depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT), 0, 0, 1};
    region.imageOffset = {rect.offset.x, rect.offset.y, 0};
    region.imageExtent = {width, height, 1};
    vkCmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1, &region);
    barrier(commands, image, depth, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, lent_layout(swapchain));
  });
  void* mapped = nullptr;
  vkMapMemory(session.device, memory, 0, VK_WHOLE_SIZE, 0, &mapped);
  captured.width = width;
  captured.height = height;
  if (depth) {
    captured.depth.resize(std::size_t(width) * height);
    std::memcpy(captured.depth.data(), mapped, bytes);
  } else {
    captured.rgba.resize(bytes);
    std::memcpy(captured.rgba.data(), mapped, bytes);
  }
  vkUnmapMemory(session.device, memory);
  vkDestroyBuffer(session.device, buffer, nullptr);
  vkFreeMemory(session.device, memory, nullptr);
}

PFN_xrVoidFunction find_swapchain_function(const std::string& name) {
  static const std::map<std::string, PFN_xrVoidFunction> all{
      {"xrEnumerateSwapchainFormats", reinterpret_cast<PFN_xrVoidFunction>(swapchain_formats)},
      {"xrCreateSwapchain", reinterpret_cast<PFN_xrVoidFunction>(create_swapchain)},
      {"xrDestroySwapchain", reinterpret_cast<PFN_xrVoidFunction>(destroy_swapchain)},
      {"xrEnumerateSwapchainImages", reinterpret_cast<PFN_xrVoidFunction>(swapchain_images)},
      {"xrAcquireSwapchainImage", reinterpret_cast<PFN_xrVoidFunction>(acquire)},
      {"xrWaitSwapchainImage", reinterpret_cast<PFN_xrVoidFunction>(wait_image)},
      {"xrReleaseSwapchainImage", reinterpret_cast<PFN_xrVoidFunction>(release)}};
  const auto it = all.find(name);
  return it == all.end() ? nullptr : it->second;
}

}  // namespace catena::test::xr_runtime
