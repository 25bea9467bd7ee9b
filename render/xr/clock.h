/// The runtime's clock against ours: CLOCK_MONOTONIC by XR_KHR_convert_timespec_time, so that hands are located at *now*, and recordings of
/// head and hands have the ticks' times. Frame thread.
#pragma once
#include <optional>

#include "render/xr/instance.h"

namespace catena::render::xr {

/// Of a time of engine/base/clock.h; nothing where the runtime does not offer it.
std::optional<XrTime> to_xr_time(const Instance& instance, std::int64_t monotonic_ns);

}  // namespace catena::render::xr
