// SPDX-License-Identifier: MIT
#include "render/vk/timestamp_query.h"

#include <bit>
#include <vector>

namespace catena::render::vk {

TimestampQueries::TimestampQueries(VkPhysicalDevice physical, VkDevice device, std::uint32_t queue_family) : device_(device) {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
  const std::uint32_t bits = queue_family < count ? families[queue_family].timestampValidBits : 0;
  if (bits == 0) return;
  if (bits < 64) mask_ = (std::uint64_t{1} << bits) - 1;
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(physical, &properties);
  ns_per_tick_ = static_cast<double>(properties.limits.timestampPeriod);
  VkQueryPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
  info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  info.queryCount = 2 * kMaxPairs;
  if (vkCreateQueryPool(device_, &info, nullptr, &pool_) != VK_SUCCESS) pool_ = VK_NULL_HANDLE;
}

TimestampQueries::~TimestampQueries() {
  if (pool_ != VK_NULL_HANDLE) vkDestroyQueryPool(device_, pool_, nullptr);
}

TimestampQueries::TimestampPair TimestampQueries::begin(VkCommandBuffer commands) {
  if (!is_supported() || free_slots_ == 0) return std::nullopt;
  const auto lap = static_cast<std::uint32_t>(std::countr_zero(free_slots_));
  free_slots_ &= ~(std::uint64_t{1} << lap);
  vkCmdResetQueryPool(commands, pool_, 2 * lap, 2);
  vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_TOP_OF_PIPE_BIT, pool_, 2 * lap);
  return lap;
}

void TimestampQueries::end(VkCommandBuffer commands, TimestampPair lap) const {
  if (lap) vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_, 2 * *lap + 1);
}

double TimestampQueries::read_ns(TimestampPair lap) {
  if (!lap) return 0;
  cancel(lap);
  std::uint64_t ticks[2] = {};
  const VkResult got = vkGetQueryPoolResults(device_, pool_, 2 * *lap, 2, sizeof(ticks), ticks, sizeof(ticks[0]), VK_QUERY_RESULT_64_BIT);
  return got == VK_SUCCESS ? ns_per_tick_ * static_cast<double>((ticks[1] - ticks[0]) & mask_) : 0;
}

void TimestampQueries::cancel(TimestampPair lap) {
  if (lap) free_slots_ |= std::uint64_t{1} << *lap;
}

}  // namespace catena::render::vk
