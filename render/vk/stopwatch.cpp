#include "render/vk/stopwatch.h"

#include <bit>
#include <vector>

namespace catena::render::vk {

Stopwatch::Stopwatch(VkPhysicalDevice physical, VkDevice device, std::uint32_t queue_family) : device_(device) {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
  const std::uint32_t bits = queue_family < count ? families[queue_family].timestampValidBits : 0;
  if (bits == 0) return;
  if (bits < 64) mask_ = (std::uint64_t{1} << bits) - 1;
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(physical, &properties);
  ns_a_tick_ = static_cast<double>(properties.limits.timestampPeriod);
  VkQueryPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
  info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  info.queryCount = 2 * kLaps;
  if (vkCreateQueryPool(device_, &info, nullptr, &pool_) != VK_SUCCESS) pool_ = VK_NULL_HANDLE;
}

Stopwatch::~Stopwatch() {
  if (pool_ != VK_NULL_HANDLE) vkDestroyQueryPool(device_, pool_, nullptr);
}

Stopwatch::Lap Stopwatch::begin(VkCommandBuffer commands) {
  if (!measures() || free_ == 0) return std::nullopt;
  const auto lap = static_cast<std::uint32_t>(std::countr_zero(free_));
  free_ &= ~(std::uint64_t{1} << lap);
  vkCmdResetQueryPool(commands, pool_, 2 * lap, 2);
  vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_TOP_OF_PIPE_BIT, pool_, 2 * lap);
  return lap;
}

void Stopwatch::end(VkCommandBuffer commands, Lap lap) const {
  if (lap) vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_, 2 * *lap + 1);
}

double Stopwatch::take(Lap lap) {
  if (!lap) return 0;
  drop(lap);
  std::uint64_t ticks[2] = {};
  const VkResult got = vkGetQueryPoolResults(device_, pool_, 2 * *lap, 2, sizeof(ticks), ticks, sizeof(ticks[0]), VK_QUERY_RESULT_64_BIT);
  return got == VK_SUCCESS ? ns_a_tick_ * static_cast<double>((ticks[1] - ticks[0]) & mask_) : 0;
}

void Stopwatch::drop(Lap lap) {
  if (lap) free_ |= std::uint64_t{1} << *lap;
}

}  // namespace catena::render::vk
