// SPDX-License-Identifier: MIT
/// Vulkan device with one queue and one timeline semaphore. A GPU is preferred over a CPU driver (lavapipe); the environment variable
/// CATENA_DEVICE (cpu, gpu, or a part of the device's name) overrides the choice. Retired objects are destroyed when the timeline has
/// passed the last submission that could use them. Frame thread only.
#pragma once
#include <vulkan/vulkan.h>

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/export.h"
#include "engine/base/result.h"
#include "render/vk/instance.h"
#include "render/vk/requirements.h"

namespace catena::render::vk {

class Image;             ///< resources.h
class Sampler;           ///< resources.h
class TimestampQueries;  ///< timestamp_query.h

/// SPIR-V words of a shader.
using Spirv = std::span<const std::uint32_t>;

/// Replacements of embedded shaders, looked up by the embedded words themselves: code that creates pipelines is not affected. Frame thread.
class CATENA_EXPORT ShaderReplacements {
 public:
  /// Makes pipelines created from here on use `words` in place of `embedded` (which must outlive this object).
  void replace(Spirv embedded, std::vector<std::uint32_t> words);
  /// Removes all replacements.
  void clear() { replacements_.clear(); }
  /// Returns the replacement of `embedded`, or `embedded` itself if there is none.
  Spirv resolve(Spirv embedded) const;

 private:
  std::vector<std::pair<Spirv, std::vector<std::uint32_t>>> replacements_;
};

/// Returns the binding numbers that a shader declares, sorted.
CATENA_EXPORT std::vector<std::uint32_t> declared_bindings(Spirv words);

/// Driver calls that can fail at any time; tests can inject failures into them.
enum class DriverCall { allocate, submit, wait };

/// Options for creating a device.
struct DeviceOptions {
  bool validation = false;    ///< enable the validation layer, if installed
  std::string device_filter;  ///< cpu, gpu or a part of a name; empty: CATENA_DEVICE, else the best device
  SurfaceFactory surface;     ///< empty: headless
  VulkanProvider provider{};  ///< empty: Catena creates all Vulkan objects
  /// Memory budget: limit of the device memory that Catena allocates on this device. 0: nine tenths of what the driver reports as available
  /// (VK_EXT_memory_budget), or eight tenths of the largest heap if it reports nothing.
  std::uint64_t memory_budget_bytes = 0;
  /// Tests only: called before each driver call; a result other than VK_SUCCESS is treated as the result of the driver.
  std::function<VkResult(DriverCall)> inject_failure{};
};

/// Properties of the device.
struct DeviceInfo {
  std::string name, driver;                                   ///< name of the device; name and version of its driver
  VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;  ///< GPU, CPU ..
  VkPhysicalDeviceLimits limits{};                            ///< Vulkan limits
  std::uint64_t memory_bytes = 0;                             ///< size of the largest device-local heap
  std::uint64_t memory_budget = 0;                            ///< bytes that Catena may allocate
  /// Returns whether it is a CPU driver.
  bool is_cpu() const { return type == VK_PHYSICAL_DEVICE_TYPE_CPU; }
};

/// Counters of the device's activity, for statistics and tests.
struct DeviceCounters {
  std::uint64_t allocated_bytes = 0;      ///< device memory allocated at present
  std::uint64_t peak_bytes = 0;           ///< maximum of allocated_bytes
  std::uint64_t uploads = 0;              ///< number of copies from staging memory
  std::uint64_t upload_bytes = 0;         ///< bytes of these copies
  std::uint64_t pipelines = 0;            ///< number of pipelines created
  std::uint64_t submissions = 0;          ///< number of command buffers submitted
  std::uint64_t allocations = 0;          ///< number of device memory allocations
  std::uint64_t refused_allocations = 0;  ///< number of allocations rejected because of the budget
  double gpu_ns = 0;                      ///< time of the completed submissions by the device's clock (timestamp_query.h)
};

/// Vulkan device. All handles belong to it or to the provider that lent them (VulkanProvider).
class CATENA_EXPORT Device {
 public:
  /// Creates or borrows instance, device and queue. A one-line Error if no device meets the requirements.
  static Result<std::unique_ptr<Device>> create(const DeviceOptions& options);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  /// Returns the Vulkan handle.
  VkDevice handle() const { return device_; }
  /// Returns the Vulkan handle.
  VkPhysicalDevice physical() const { return physical_; }
  /// Returns the Vulkan handle.
  VkInstance instance() const { return instance_->handle(); }
  /// Returns the queue; there is only one.
  VkQueue queue() const { return queue_; }
  /// Returns the queue's family.
  std::uint32_t queue_family() const { return queue_family_; }
  /// Returns a lock to be held while the queue is used, as others may share it (VulkanProvider).
  [[nodiscard]] std::unique_lock<std::mutex> lock_queue() const {
    return provider_.queue_lock != nullptr ? std::unique_lock(*provider_.queue_lock) : std::unique_lock<std::mutex>();
  }
  /// Returns a command buffer in the initial state; buffers are recycled. An Error if the driver refuses.
  Result<VkCommandBuffer> acquire_command_buffer();
  /// Returns a command buffer to the pool when its work is done.
  void release_command_buffer(VkCommandBuffer buffer);
  /// Returns the window's surface; null without a window.
  VkSurfaceKHR surface() const { return instance_->surface(); }
  /// Returns the properties of the device.
  const DeviceInfo& info() const { return info_; }
  /// Returns the warnings and errors reported so far.
  const Messages& messages() const { return instance_->messages(); }
  /// Returns the counters.
  DeviceCounters& counters() { return counters_; }
  /// Returns the counters.
  const DeviceCounters& counters() const { return counters_; }
  /// Returns the replacements of embedded shaders.
  ShaderReplacements& shaders() { return shaders_; }
  /// Returns the timestamp queries that measure the submitted work (timestamp_query.h).
  TimestampQueries& timestamps() { return *timestamps_; }
  /// Returns the bytes of the memory budget that are not allocated.
  std::uint64_t memory_available() const {
    return counters_.allocated_bytes < info_.memory_budget ? info_.memory_budget - counters_.allocated_bytes : 0;
  }
  /// Deliberately leaks the device and its instance, because a call of another owner that uses them never returns.
  void abandon();
  /// Returns whether the device is lost (VK_ERROR_DEVICE_LOST): it cannot render; a new one can render the same packets.
  bool is_lost() const { return is_lost_; }
  /// Returns the result that a test injects for the driver call; VK_SUCCESS: none.
  VkResult injected_failure(DriverCall call) const { return inject_failure_ ? inject_failure_(call) : VK_SUCCESS; }
  /// Returns vkCmdPushDescriptorSetKHR of this device.
  PFN_vkCmdPushDescriptorSetKHR push_descriptors() const { return push_descriptors_; }

  /// Sets the image that Commands::bind() adds to the bindings of every pipeline which has kSharedBinding; both must outlive its use.
  void share(const Image& image, const Sampler& sampler) { shared_image_ = &image, shared_sampler_ = &sampler; }
  /// Returns the image; null: none.
  const Image* shared_image() const { return shared_image_; }
  /// Returns its sampler.
  const Sampler* shared_sampler() const { return shared_sampler_; }

  /// Returns the timeline semaphore.
  VkSemaphore timeline() const { return timeline_; }
  /// Returns the timeline value that the last submission signals.
  std::uint64_t submitted_value() const { return submitted_value_; }
  /// Submits a command buffer; returns the timeline value reached when its work is done. Optional binary semaphores for a swapchain.
  Result<std::uint64_t> submit(VkCommandBuffer commands, VkSemaphore wait = VK_NULL_HANDLE, VkSemaphore signal = VK_NULL_HANDLE);
  /// Waits until the timeline has reached `value`, then destroys the objects retired by then. An Error if the device is lost.
  Outcome wait(std::uint64_t value);
  /// Waits for all submitted work.
  Outcome wait_idle() { return wait(submitted_value_); }

  /// Schedules `destroy` for when all work submitted so far is done (in a later wait(), or when the device is destroyed).
  void retire(std::function<void()> destroy);
  /// Returns the number of objects waiting to be destroyed.
  std::size_t retired_count() const { return retired_.size(); }

 private:
  Device() = default;
  Outcome select_physical_device(const std::string& choice);
  Outcome adopt_physical_device();
  void query_device_info();
  std::uint64_t default_budget() const;
  Error failed(VkResult result, const std::string& what);
  Outcome create_device();
  void destroy_retired();

  struct Retired {
    std::uint64_t value;
    std::function<void()> destroy;
  };
  VulkanProvider provider_;
  std::unique_ptr<Instance> instance_;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  std::uint32_t queue_family_ = 0;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  std::vector<VkCommandBuffer> idle_commands_;  // recycled command buffers of the pool
  VkSemaphore timeline_ = VK_NULL_HANDLE;
  std::uint64_t submitted_value_ = 0, completed_value_ = 0;
  std::unique_ptr<TimestampQueries> timestamps_;
  std::deque<Retired> retired_;
  DeviceInfo info_;
  DeviceCounters counters_;
  ShaderReplacements shaders_;
  std::function<VkResult(DriverCall)> inject_failure_;
  bool is_lost_ = false;
  PFN_vkCmdPushDescriptorSetKHR push_descriptors_ = nullptr;
  const Image* shared_image_ = nullptr;
  const Sampler* shared_sampler_ = nullptr;
};

/// Returns one line per device: name, type, Vulkan version, driver.
CATENA_EXPORT Result<std::vector<std::string>> list_devices();

}  // namespace catena::render::vk
