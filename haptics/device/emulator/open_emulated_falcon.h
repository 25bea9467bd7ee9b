/// The device type "emulated-falcon": the real Falcon driver over the emulator, with a hand that homes it and moves gently
/// around the workspace, for machines without the hardware; "emulated-falcon:still": with one that then rests, as the self-test's
/// pushes expect. Where settings.firmware is stated the device has none yet, and boots that file.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "haptics/device/emulator/emulated_mechanism.h"
#include "haptics/device/registry.h"

namespace catena::haptics {

/// Pulls the grip out and pushes it in (homing), pulls it out once more (arming), then goes round and round: 14 s, of which the
/// last 8 repeat.
EmulatedHand gentle_hand();
/// Homes and arms the same way, then rests at z = 0.12 m from 3 s on.
EmulatedHand still_hand();

void list_emulated_falcon(std::vector<DeviceInfo>& to);
Result<std::unique_ptr<Device>> open_emulated_falcon(const std::string& detail, const DeviceSettings& settings);

}  // namespace catena::haptics
