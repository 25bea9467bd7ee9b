// SPDX-License-Identifier: MIT
/// Execution time of submitted work by the device's clock: a pair of timestamps around each command buffer. On a GPU, unlike wall time, it
/// excludes other programs and the processor; with a CPU driver it equals wall time.
///   auto pair = queries.begin(buffer); .. queries.end(buffer, pair); submit; wait; ns += queries.read_ns(pair);
/// Overlapping intervals of command buffers that run concurrently are counted twice. Frame thread.
#pragma once
#include <vulkan/vulkan.h>

#include <cstdint>
#include <optional>

namespace catena::render::vk {

/// Pool of timestamp query pairs.
class TimestampQueries {
 public:
  using TimestampPair = std::optional<std::uint32_t>;  ///< index of a query pair; nullopt: not measured

  /// If the queue family has no timestamps or memory is short, nothing is measured.
  TimestampQueries(VkPhysicalDevice physical, VkDevice device, std::uint32_t queue_family);
  ~TimestampQueries();
  TimestampQueries(const TimestampQueries&) = delete;
  TimestampQueries& operator=(const TimestampQueries&) = delete;

  /// Returns whether work is measured.
  bool is_supported() const { return pool_ != VK_NULL_HANDLE; }
  /// Records the first timestamp, outside a render pass. nullopt if too many pairs are in use.
  TimestampPair begin(VkCommandBuffer commands);
  /// Records the second timestamp; nothing for nullopt.
  void end(VkCommandBuffer commands, TimestampPair lap) const;
  /// Returns the nanoseconds of a pair whose work is done, and frees the pair. 0 if not available.
  double read_ns(TimestampPair lap);
  /// Frees a pair whose commands are never executed.
  void cancel(TimestampPair lap);

 private:
  static constexpr std::uint32_t kMaxPairs = 64;
  VkDevice device_;
  VkQueryPool pool_ = VK_NULL_HANDLE;
  double ns_per_tick_ = 1;
  std::uint64_t mask_ = ~std::uint64_t{0};        ///< valid bits of a timestamp
  std::uint64_t free_slots_ = ~std::uint64_t{0};  ///< one bit per pair
};

}  // namespace catena::render::vk
