/// What a device may be asked for: its own capabilities, bounded by what the person says. Off the tick.
#pragma once
#include "haptics/chain/limits.h"
#include "haptics/device/settings.h"

namespace catena::haptics {

/// The mechanism, with what the settings say of it.
Mechanics mechanics_of(const DeviceCapabilities& device, const DeviceSettings& settings);
Limits limits_for(const DeviceCapabilities& device, const DeviceSettings& settings);

}  // namespace catena::haptics
