// SPDX-License-Identifier: MIT
/// Conversion from CLOCK_MONOTONIC to the runtime's clock by XR_KHR_convert_timespec_time, to locate controllers at the current time and to
/// record head and controllers with the time stamps of haptic ticks. Frame thread.
#pragma once
#include <optional>

#include "render/xr/instance.h"

namespace catena::render::xr {

/// Converts a time of engine/base/clock.h; nullopt if the runtime does not support it.
std::optional<XrTime> to_xr_time(const Instance& instance, std::int64_t monotonic_ns);

}  // namespace catena::render::xr
