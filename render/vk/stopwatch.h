/// What the device's work takes by its own clock: a pair of timestamps around each command buffer. On a GPU the time on the wall holds what
/// other programs and the processor do beside; on a driver that draws with the processor this is the time on the wall.
///   auto lap = stopwatch.begin(buffer); .. stopwatch.end(buffer, lap); submit; wait; ns += stopwatch.take(lap);
/// Laps of command buffers that run beside each other count twice. Frame thread.
#pragma once
#include <vulkan/vulkan.h>

#include <cstdint>
#include <optional>

namespace catena::render::vk {

class Stopwatch {
 public:
  using Lap = std::optional<std::uint32_t>;  ///< none: not measured

  /// A queue family without timestamps, or too little memory: none is ever measured.
  Stopwatch(VkPhysicalDevice physical, VkDevice device, std::uint32_t queue_family);
  ~Stopwatch();
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

  bool measures() const { return pool_ != VK_NULL_HANDLE; }
  /// Outside a pass. None where too many laps are on their way.
  Lap begin(VkCommandBuffer commands);
  void end(VkCommandBuffer commands, Lap lap) const;
  /// Nanoseconds of a lap whose work is done; the lap is over. 0 where they cannot be had.
  double take(Lap lap);
  /// The lap's commands never run.
  void drop(Lap lap);

 private:
  static constexpr std::uint32_t kLaps = 64;
  VkDevice device_;
  VkQueryPool pool_ = VK_NULL_HANDLE;
  double ns_a_tick_ = 1;
  std::uint64_t mask_ = ~std::uint64_t{0};  ///< the bits that count
  std::uint64_t free_ = ~std::uint64_t{0};  ///< a bit a lap
};

}  // namespace catena::render::vk
