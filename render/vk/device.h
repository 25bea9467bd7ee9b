/// One device, one queue, one timeline. A GPU is taken when there is one, a CPU driver (lavapipe) otherwise; the environment
/// variable CATENA_DEVICE (cpu, gpu, or a part of the device's name) decides otherwise. What is retired is destroyed once the
/// timeline has passed the last submission that could use it. Frame thread only.
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

#include "engine/base/result.h"
#include "render/vk/instance.h"
#include "render/vk/requirements.h"

namespace catena::render::vk {

class TimestampQueries;  ///< stopwatch.h

/// A shader's words.
using Spirv = std::span<const std::uint32_t>;

/// Shaders that stand in for embedded ones, by the embedded words themselves: what creates pipelines need not know of it. Frame thread.
class ShaderReplacements {
 public:
  /// Pipelines created from now on have `words` in the place of `embedded` (which outlives this).
  void replace(Spirv embedded, std::vector<std::uint32_t> words);
  /// The embedded ones again.
  void clear() { replacements_.clear(); }
  /// What stands in for `embedded`: itself, where nothing does.
  Spirv resolve(Spirv embedded) const;

 private:
  std::vector<std::pair<Spirv, std::vector<std::uint32_t>>> replacements_;
};

/// The bindings that a shader declares, sorted.
std::vector<std::uint32_t> declared_bindings(Spirv words);

/// The calls that a driver may refuse at any time: what a test can make fail.
enum class DriverCall { allocate, submit, wait };

/// How a device is made.
struct DeviceOptions {
  bool validation = false;    ///< with the validation layer, where it is installed
  std::string device_filter;  ///< cpu, gpu or a part of a name; empty: CATENA_DEVICE, else the best one
  SurfaceFactory surface;     ///< empty: headless
  VulkanProvider provider{};  ///< empty: Catena makes all of it
  /// Of device memory, all that Catena allocates on this device. 0: nine tenths of what the driver offers now
  /// (VK_EXT_memory_budget), or eight tenths of the largest heap where it does not say.
  std::uint64_t memory_budget_bytes = 0;
  /// Tests only: asked before each call; what it returns instead of VK_SUCCESS is taken for the driver's answer.
  std::function<VkResult(DriverCall)> inject_failure{};
};

/// What the device is.
struct DeviceInfo {
  std::string name, driver;                                   ///< its name; its driver's name and version
  VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;  ///< GPU, CPU ..
  VkPhysicalDeviceLimits limits{};                            ///< as Vulkan gives them
  std::uint64_t memory_bytes = 0;                             ///< of the largest device-local heap
  std::uint64_t memory_budget = 0;                            ///< bytes that Catena may hold
  /// Whether the processor draws.
  bool is_cpu() const { return type == VK_PHYSICAL_DEVICE_TYPE_CPU; }
};

/// What the device has done so far; tests read it.
struct DeviceCounters {
  std::uint64_t allocated_bytes = 0;      ///< device memory held now
  std::uint64_t peak_bytes = 0;           ///< the most that was ever held
  std::uint64_t uploads = 0;              ///< copies from staging memory
  std::uint64_t upload_bytes = 0;         ///< bytes of these copies
  std::uint64_t pipelines = 0;            ///< created
  std::uint64_t submissions = 0;          ///< of command buffers
  std::uint64_t allocations = 0;          ///< of device memory
  std::uint64_t refused_allocations = 0;  ///< allocations that the budget did not hold
  double gpu_ns = 0;                      ///< of what was submitted and is done, by the device's clock (stopwatch.h)
};

/// The device. All handles belong to it, or to who lent them (VulkanProvider).
class Device {
 public:
  /// Makes or borrows instance, device and queue. An error where no device has what Catena needs: one sentence.
  static Result<std::unique_ptr<Device>> create(const DeviceOptions& options);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  /// Vulkan's handle.
  VkDevice handle() const { return device_; }
  /// Vulkan's handle.
  VkPhysicalDevice physical() const { return physical_; }
  /// Vulkan's handle.
  VkInstance instance() const { return instance_->handle(); }
  /// Its one queue.
  VkQueue queue() const { return queue_; }
  /// The queue's family.
  std::uint32_t queue_family() const { return queue_family_; }
  /// Held while the queue is used: others may use it, too (VulkanProvider).
  [[nodiscard]] std::unique_lock<std::mutex> lock_queue() const {
    return provider_.queue_lock != nullptr ? std::unique_lock(*provider_.queue_lock) : std::unique_lock<std::mutex>();
  }
  /// A command buffer to record, and back with it when its work is done: they are used again and again.
  Result<VkCommandBuffer> acquire_command_buffer();
  /// Of acquire_command_buffer(): empty afterwards.
  void release_command_buffer(VkCommandBuffer buffer);
  /// The window's surface; null without a window.
  VkSurfaceKHR surface() const { return instance_->surface(); }
  /// What the device is.
  const DeviceInfo& info() const { return info_; }
  /// Warnings and errors so far.
  const Messages& messages() const { return instance_->messages(); }
  /// What it has done so far.
  DeviceCounters& counters() { return counters_; }
  /// What it has done so far.
  const DeviceCounters& counters() const { return counters_; }
  /// What stands in for embedded shaders.
  ShaderReplacements& shaders() { return shaders_; }
  /// What takes the time of the work that was submitted (stopwatch.h).
  TimestampQueries& timestamps() { return *timestamps_; }
  /// Bytes that the budget still holds.
  std::uint64_t memory_available() const {
    return counters_.allocated_bytes < info_.memory_budget ? info_.memory_budget - counters_.allocated_bytes : 0;
  }
  /// It and its instance are not destroyed: another one's call that uses them never ends.
  void abandon();
  /// The driver gave the device up: nothing can be drawn with it any more. A new one can be made from the same packets.
  bool is_lost() const { return is_lost_; }
  /// What a test pretends that the driver says.
  VkResult injected_failure(DriverCall call) const { return inject_failure_ ? inject_failure_(call) : VK_SUCCESS; }
  /// VkCmdPushDescriptorSetKHR of this device.
  PFN_vkCmdPushDescriptorSetKHR push_descriptors() const { return push_descriptors_; }

  /// Its one timeline semaphore, and the value that the last submission reaches.
  VkSemaphore timeline() const { return timeline_; }
  /// The value that the last submission reaches.
  std::uint64_t submitted_value() const { return submitted_value_; }
  /// Submits and returns the timeline value that is reached when the work is done. Optional binary semaphores for a swapchain.
  Result<std::uint64_t> submit(VkCommandBuffer commands, VkSemaphore wait = VK_NULL_HANDLE, VkSemaphore signal = VK_NULL_HANDLE);
  /// Waits until the timeline has reached `value`, and destroys what is retired by then. An error where the device is lost.
  Outcome wait(std::uint64_t value);
  /// Waits for all that was submitted.
  Outcome wait_idle() { return wait(submitted_value_); }

  /// Calls `destroy` once everything submitted so far is done (at a later wait, or when the device goes).
  void retire(std::function<void()> destroy);
  /// Things that wait to be destroyed.
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
  std::vector<VkCommandBuffer> idle_commands_;  // of the pool
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
};

/// One line a device: name, type, Vulkan version, driver.
Result<std::vector<std::string>> list_devices();

}  // namespace catena::render::vk
