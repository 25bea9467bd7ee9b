/// What the device's work takes by its own clock: a pair of timestamps around each command buffer. On a GPU the time on the wall holds what
/// other programs and the processor do beside; on a driver that draws with the processor this is the time on the wall.
///   auto lap = stopwatch.begin(buffer); .. stopwatch.end(buffer, lap); submit; wait; ns += stopwatch.take(lap);
/// Laps of command buffers that run beside each other count twice. Frame thread.
#pragma once
#include <vulkan/vulkan.h>

#include <cstdint>
#include <optional>

namespace catena::render::vk {

class TimestampQueries {
 public:
  using TimestampPair = std::optional<std::uint32_t>;  ///< none: not measured

  /// A queue family without timestamps, or too little memory: none is ever measured.
  TimestampQueries(VkPhysicalDevice physical, VkDevice device, std::uint32_t queue_family);
  ~TimestampQueries();
  TimestampQueries(const TimestampQueries&) = delete;
  TimestampQueries& operator=(const TimestampQueries&) = delete;

  bool is_supported() const { return pool_ != VK_NULL_HANDLE; }
  /// OutwardSide a pass. None where too many laps are on their way.
  TimestampPair begin(VkCommandBuffer commands);
  void end(VkCommandBuffer commands, TimestampPair lap) const;
  /// Nanoseconds of a lap whose work is done; the lap is over. 0 where they cannot be had.
  double read_ns(TimestampPair lap);
  /// The lap's commands never run.
  void cancel(TimestampPair lap);

 private:
  static constexpr std::uint32_t kMaxPairs = 64;
  VkDevice device_;
  VkQueryPool pool_ = VK_NULL_HANDLE;
  double ns_per_tick_ = 1;
  std::uint64_t mask_ = ~std::uint64_t{0};        ///< the bits that count
  std::uint64_t free_slots_ = ~std::uint64_t{0};  ///< a bit a lap
};

}  // namespace catena::render::vk
