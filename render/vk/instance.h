/// Every VkResult becomes a Result with one sentence.
#pragma once
#include <vulkan/vulkan.h>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena::render::vk {

/// "VK_ERROR_DEVICE_LOST" and so on.
const char* result_name(VkResult result);
/// "Vulkan could not WHAT: VK_ERROR_..."
Error vulkan_error(VkResult result, const std::string& what);

}  // namespace catena::render::vk

/// Returns an error from the function around it unless the call succeeds.
#define CATENA_VK(call, what) \
  if (const VkResult vk_result = (call); vk_result != VK_SUCCESS) return ::catena::render::vk::vulkan_error(vk_result, what)

namespace catena::render::vk {

/// Where a window's surface comes from; the viewer passes it, headless programs have none.
struct SurfaceFactory {
  std::vector<std::string> instance_extensions;               ///< that the surface needs
  std::function<VkResult(VkInstance, VkSurfaceKHR*)> create;  ///< Makes the surface of an instance.
  /// Whether there is a window.
  explicit operator bool() const { return static_cast<bool>(create); }
};

/// Makes Vulkan objects in Catena's place, and says which queue is used: for a headset's runtime, or for a program that draws with a device
/// of its own. Catena makes what no function is set for. The extensions, layers and features that a function is asked for are needed; it
/// may add others. What it returns instead of VK_SUCCESS becomes the error. Frame thread.
struct VulkanProvider {
  /// As vkCreateInstance.
  std::function<VkResult(const VkInstanceCreateInfo& wanted, VkInstance* made)> instance;
  /// Of the instance; it still has to have what Catena needs.
  std::function<VkResult(VkInstance instance, VkPhysicalDevice* chosen)> physical_device;
  /// As vkCreateDevice: one queue that draws and computes.
  std::function<VkResult(VkPhysicalDevice physical, const VkDeviceCreateInfo& wanted, VkDevice* made)> device;
  /// Of the queue, its first one is used; none: the first family that draws and computes.
  std::optional<std::uint32_t> queue_family;
  /// Held around every use of the queue, where others use it too; it outlives the device.
  std::mutex* queue_lock = nullptr;
  /// Whether instance and device stay theirs: Catena does not destroy them.
  bool keeps_ownership = false;
};

/// Warnings and errors so far; the driver may report from any thread.
class Messages {
 public:
  /// Adds a message.
  void add(std::string text);
  /// Messages so far.
  std::uint64_t count() const;
  std::vector<std::string> texts() const;  ///< the first 64

 private:
  mutable std::mutex mutex_;
  std::uint64_t count_ = 0;
  std::vector<std::string> texts_;
};

/// The Vulkan instance: version 1.3, with the validation layer (synchronization checks on) when asked for. Warnings and errors of
/// the layer and the loader are counted and their texts kept; tests assert that there are none. Frame thread.
class Instance {
 public:
  /// Makes or borrows it. An error is one sentence.
  static Result<std::unique_ptr<Instance>> create(bool validation, const SurfaceFactory& surface, const VulkanProvider& maker = {});
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  /// Vulkan's handle.
  VkInstance handle() const { return instance_; }
  /// The window's surface; null without a window.
  VkSurfaceKHR surface() const { return surface_; }
  /// Warnings and errors so far.
  const Messages& messages() const { return messages_; }
  /// It is not destroyed.
  void abandon() { owned_ = false; }

 private:
  Instance() = default;
  VkInstance instance_ = VK_NULL_HANDLE;
  bool owned_ = true;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  VkSurfaceKHR surface_ = VK_NULL_HANDLE;
  Messages messages_;
};

}  // namespace catena::render::vk
