// SPDX-License-Identifier: MIT
#include "render/xr/clock.h"

namespace catena::render::xr {

std::optional<XrTime> to_xr_time(const Instance& instance, std::int64_t monotonic_ns) {
  const auto convert = instance.dispatch().ConvertTimespecTimeToTimeKHR;
  if (!instance.capabilities().clock || !convert) return std::nullopt;
  constexpr std::int64_t kSecond = 1'000'000'000;
  const timespec at{monotonic_ns / kSecond, monotonic_ns % kSecond};
  XrTime time = 0;
  if (XR_FAILED(convert(instance.handle(), &at, &time)) || time <= 0) return std::nullopt;
  return time;
}

}  // namespace catena::render::xr
