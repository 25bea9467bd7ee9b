#include "haptics/device/emulator/open_emulated_falcon.h"

#include <numbers>

#include "haptics/device/emulator/emulated_transport.h"
#include "haptics/device/usb/falcon.h"
#include "haptics/device/usb/falcon_image.h"
#include "haptics/device/usb/open_falcon.h"

namespace catena::haptics {

EmulatedHand gentle_hand() {
  EmulatedHand hand;
  hand.path = {{0, {0, 0, 0.12}, 0},    {0.5, {0, 0, 0.12}, 0}, {1.5, {0, 0, 0.176}, 0},  {2.5, {0, 0, 0.13}, 0},
               {3.5, {0, 0, 0.176}, 0}, {4, {0, 0, 0.176}, 0},  {6, {0.025, 0, 0.115}, 0}};
  hand.repeat_from_s = 6;
  constexpr int kSteps = 64;
  for (int i = 1; i <= kSteps; ++i) {
    const double share = static_cast<double>(i) / kSteps, turn = 2 * std::numbers::pi * share;
    hand.path.push_back({6 + 8 * share, {0.025 * std::cos(turn), 0.025 * std::sin(turn), 0.115 + 0.015 * std::sin(2 * turn)}, 0});
  }
  return hand;
}

EmulatedHand still_hand() {
  EmulatedHand hand;
  hand.path = {{0, {0, 0, 0.12}, 0},    {0.3, {0, 0, 0.12}, 0},  {1, {0, 0, 0.176}, 0}, {1.6, {0, 0, 0.13}, 0},
               {2.2, {0, 0, 0.176}, 0}, {2.5, {0, 0, 0.176}, 0}, {3, {0, 0, 0.12}, 0}};
  return hand;
}

void list_emulated_falcon(std::vector<DeviceInfo>& to) {
  to.push_back({"emulated-falcon", true, "the Falcon's driver on an emulated device in a moving hand: no hardware"});
  to.push_back({"emulated-falcon:still", true, "the same in a hand that rests once it has homed: for devices test --forces"});
}

Result<std::unique_ptr<Device>> open_emulated_falcon(const std::string& detail, const DeviceSettings& settings) {
  if (!detail.empty() && detail != "still")
    return Error{"\"emulated-falcon:" + detail + "\" is not known; \"emulated-falcon\" or \"emulated-falcon:still\" was expected"};
  usb::FalconOptions options;
  if (!settings.firmware.empty()) {
    CATENA_TRY(options.firmware, usb::read_falcon_image(settings.firmware));
  }
  options.boot.progress = usb::boot_progress_lines(settings.tell);
  auto shared = std::make_shared<SharedEmulatedFalcon>(EmulatedFalconOptions{.firmware = settings.firmware.empty()});
  shared->device.mechanism().carry(detail == "still" ? still_hand() : gentle_hand());
  options.force_gain = settings.force_gain;
  options.command_timeout_s = usb::falcon_command_timeout_s(settings.rate_hz);
  CATENA_TRY(std::unique_ptr<Device> device,
             usb::Falcon::open(std::make_unique<EmulatedSource>(std::move(shared), true), std::move(options)));
  return device;
}

}  // namespace catena::haptics
