// SPDX-License-Identifier: MIT
#include <string>

#include "render/vk/requirements.h"
#include "render/xr/instance.h"

namespace catena::render::xr {

namespace {

/// Returns Vulkan's result if the runtime succeeded, else an initialization failure.
VkResult answer(Instance& instance, XrResult said, VkResult vulkan, const char* what) {
  if (XR_SUCCEEDED(said)) return vulkan;
  (void)instance.failed(said, what);
  return VK_ERROR_INITIALIZATION_FAILED;
}

/// Device features in separate structures instead of VkPhysicalDeviceVulkan12Features: a runtime (Monado) adds
/// VkPhysicalDeviceTimelineSemaphoreFeatures to a chain without it, which must not be combined with the former. Points into itself.
struct SplitFeatures {
  VkPhysicalDeviceFeatures2 core{};
  VkPhysicalDeviceTimelineSemaphoreFeatures timeline{};
  VkPhysicalDeviceScalarBlockLayoutFeatures scalar{};
  VkPhysicalDeviceVulkan13Features v13{};

  SplitFeatures() {
    vk::DeviceFeatures needed;
    vk::enable_required(needed);
    v13 = needed.v13;
    core.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    core.features = needed.core.features;
    core.pNext = &timeline;
    timeline.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES;
    timeline.timelineSemaphore = needed.v12.timelineSemaphore;
    timeline.pNext = &scalar;
    scalar.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES;
    scalar.scalarBlockLayout = needed.v12.scalarBlockLayout;
    scalar.pNext = &v13;
    v13.pNext = nullptr;
  }
  SplitFeatures(const SplitFeatures&) = delete;
  SplitFeatures& operator=(const SplitFeatures&) = delete;
};

}  // namespace

vk::VulkanProvider Instance::vulkan_provider(std::mutex& queue_lock) {
  vk::VulkanProvider maker;
  maker.instance = [this](const VkInstanceCreateInfo& wanted, VkInstance* made) {
    // OpenXR requires this call before the instance is created; Catena needs 1.3 in any case
    XrGraphicsRequirementsVulkan2KHR versions{};
    versions.type = XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN2_KHR;
    const XrResult asked = dispatch_.GetVulkanGraphicsRequirements2KHR(instance_, system_, &versions);
    if (XR_FAILED(asked)) return answer(*this, asked, VK_SUCCESS, "say which Vulkan it takes");
    if (versions.minApiVersionSupported > XR_MAKE_VERSION(1, 3, 0xffff)) return VK_ERROR_INCOMPATIBLE_DRIVER;
    XrVulkanInstanceCreateInfoKHR info{};
    info.type = XR_TYPE_VULKAN_INSTANCE_CREATE_INFO_KHR;
    info.systemId = system_;
    info.pfnGetInstanceProcAddr = vkGetInstanceProcAddr;
    info.vulkanCreateInfo = &wanted;
    VkResult result = VK_SUCCESS;
    return answer(*this, dispatch_.CreateVulkanInstanceKHR(instance_, &info, made, &result), result, "make a Vulkan instance");
  };
  maker.physical_device = [this](VkInstance of, VkPhysicalDevice* chosen) {
    XrVulkanGraphicsDeviceGetInfoKHR info{};
    info.type = XR_TYPE_VULKAN_GRAPHICS_DEVICE_GET_INFO_KHR;
    info.systemId = system_;
    info.vulkanInstance = of;
    return answer(*this, dispatch_.GetVulkanGraphicsDevice2KHR(instance_, &info, chosen), VK_SUCCESS, "choose a Vulkan device");
  };
  maker.device = [this](VkPhysicalDevice physical, const VkDeviceCreateInfo& wanted, VkDevice* made) {
    XrVulkanDeviceCreateInfoKHR info{};
    info.type = XR_TYPE_VULKAN_DEVICE_CREATE_INFO_KHR;
    info.systemId = system_;
    info.pfnGetInstanceProcAddr = vkGetInstanceProcAddr;
    info.vulkanPhysicalDevice = physical;
    const SplitFeatures features;
    VkDeviceCreateInfo split = wanted;
    split.pNext = &features.core;
    info.vulkanCreateInfo = &split;
    VkResult result = VK_SUCCESS;
    return answer(*this, dispatch_.CreateVulkanDeviceKHR(instance_, &info, made, &result), result, "make a Vulkan device");
  };
  maker.queue_lock = &queue_lock;
  return maker;
}

}  // namespace catena::render::xr
