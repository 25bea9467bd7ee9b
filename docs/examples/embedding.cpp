// SPDX-License-Identifier: MIT
// Catena draws with the instance, device and queue of a Vulkan program that is there already. The program asks before it makes its device
// what Catena needs of it, lends it, and takes the picture as an image of the same device: nothing goes through the host.
#include <vulkan/vulkan.h>

#include <cstdio>
#include <cstring>
#include <memory>
#include <mutex>
#include <vector>

#include "engine/scene/scene.h"
#include "render/extract/extract.h"
#include "render/passes/renderer.h"

using namespace catena;
namespace vk = render::vk;

// ---- the program that is there already ----

struct Host {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  std::uint32_t family = 0;
  std::mutex queue;

  Outcome make() {
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.apiVersion = vk::kApiVersion;
    VkInstanceCreateInfo wanted{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    wanted.pApplicationInfo = &application;
    CATENA_VK(vkCreateInstance(&wanted, nullptr, &instance), "make the instance");
    std::uint32_t count = 16;
    VkPhysicalDevice all[16];
    vkEnumeratePhysicalDevices(instance, &count, all);
    for (std::uint32_t i = 0; i < count && physical == VK_NULL_HANDLE; ++i)
      if (vk::missing_requirement(all[i]).empty()) physical = all[i];
    if (physical == VK_NULL_HANDLE) return Error{"no device has what Catena needs"};

    // a queue family that draws and computes
    VkQueueFamilyProperties families[16];
    count = 16;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families);
    constexpr VkQueueFlags kBoth = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    while (family + 1 < count && (families[family].queueFlags & kBoth) != kBoth) ++family;

    vk::DeviceFeatures features;
    vk::enable_required(features);  // and what this program itself needs
    const std::vector<const char*> extensions = vk::required_extensions();
    const float priority = 1;
    VkDeviceQueueCreateInfo one{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    one.queueFamilyIndex = family;
    one.queueCount = 1;
    one.pQueuePriorities = &priority;
    VkDeviceCreateInfo made{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    made.pNext = &features.core;
    made.queueCreateInfoCount = 1;
    made.pQueueCreateInfos = &one;
    made.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    made.ppEnabledExtensionNames = extensions.data();
    CATENA_VK(vkCreateDevice(physical, &made, nullptr, &device), "make the device");
    return Done{};
  }
  ~Host() {
    if (device != VK_NULL_HANDLE) vkDestroyDevice(device, nullptr);
    if (instance != VK_NULL_HANDLE) vkDestroyInstance(instance, nullptr);
  }

  // What Catena asks for is there already.
  vk::VulkanProvider lend() {
    vk::VulkanProvider provider;
    provider.instance = [this](const VkInstanceCreateInfo&, VkInstance* out) { return *out = instance, VK_SUCCESS; };
    provider.physical_device = [this](VkInstance, VkPhysicalDevice* out) { return *out = physical, VK_SUCCESS; };
    provider.device = [this](VkPhysicalDevice, const VkDeviceCreateInfo&, VkDevice* out) { return *out = device, VK_SUCCESS; };
    provider.queue_family = family;
    provider.queue_lock = &queue;
    provider.keeps_ownership = true;
    return provider;
  }
};

Outcome run() {
  Host host;
  CATENA_CHECK(host.make());
  CATENA_TRY(scene::Scene scene, scene::parse_scene(R"({"fields": {"ball": {"analytic": "sphere", "resolution": 32}},
    "isosurfaces": [{"field": "ball", "level": 1}]})",
                                                    "embedding"));
  CATENA_TRY(const render::FramePacket packet, render::make_frame(scene, 160, 120));
  vk::DeviceOptions options;
  options.provider = host.lend();
  CATENA_TRY(const auto renderer, render::Renderer::create(options));
  CATENA_CHECK(renderer->draw(packet));

  // the picture, ready for a blit or a copy by the program's own commands; they wait for `value` of the timeline semaphore
  const render::RenderedImage image = renderer->rendered_image();
  std::uint64_t reached = 0;
  CATENA_VK(vkGetSemaphoreCounterValue(host.device, image.timeline, &reached), "look at the timeline");
  std::printf("an image of %u x %u, %s, timeline %s\n", image.extent.width, image.extent.height,
              image.layout == VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL ? "TRANSFER_SRC_OPTIMAL" : "in another layout",
              reached >= image.timeline_value ? "reached" : "not reached yet");
  return Done{};
}

int main() {
  if (const Outcome done = run(); !done) return std::fprintf(stderr, "%s\n", done.error().message.c_str()), 1;
  return 0;
}
