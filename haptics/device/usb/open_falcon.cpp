// SPDX-License-Identifier: MIT
#include "haptics/device/usb/falcon.h"

#include <fmt/format.h>

#include "engine/base/helper_process.h"
#include "engine/base/numbers.h"
#include "haptics/device/usb/falcon_boot.h"
#include "haptics/device/usb/libusb_transport.h"

namespace catena::haptics::usb {
namespace {

constexpr int kMaximum = 16;
constexpr int kIoPriority = 82;  // above the servo's own thread, because it mostly waits for the bus

}  // namespace

void list_falcons(std::vector<DeviceInfo>& to) {
  const auto listed = list_usb(kFalconUsbId);
  if (!listed) {
    to.push_back({"falcon", false, "Novint Falcon: " + listed.error().message});
    return;
  }
  if (listed->empty())
    to.push_back({"falcon", false, "Novint Falcon: none on the USB bus (0403:cb48); connect the USB cable and the power"});
  for (std::size_t i = 0; i < listed->size(); ++i)
    to.push_back({i == 0 ? "falcon" : fmt::format("falcon:{}", i), (*listed)[i].can_open, "Novint Falcon, " + (*listed)[i].detail});
}

std::function<bool(int, double)> make_boot_progress_reporter(std::function<void(const std::string&)> on_message) {
  return [on_message = std::move(on_message), reported = std::string()](int attempt, double share) mutable {
    std::string line = fmt::format("Falcon: the firmware is being sent, attempt {}, {} %", attempt, 10 * static_cast<int>(10 * share));
    if (on_message && line != reported) on_message(line);
    reported = std::move(line);
    return true;
  };
}

Result<std::unique_ptr<Device>> open_falcon(const std::string& detail, const DeviceSettings& settings) {
  const auto index = detail.empty() ? 0 : parse_integer(detail);
  if (!index || *index < 0 || *index >= kMaximum)
    return Error{"falcon:" + detail + ": the number is invalid; falcon, falcon:1 (the second device), ... was expected"};
  FalconOptions options;
  options.force_gain = settings.force_gain;
  options.command_timeout_s = falcon_command_timeout_s(settings.rate_hz);
  options.realtime_priority = kIoPriority;
  if (!settings.firmware.empty()) {
    CATENA_TRY(options.firmware, read_falcon_image(settings.firmware));
  }
  options.watchdog = make_watchdog_launcher(helper_path("catena-watchdog"));
  options.boot.progress = make_boot_progress_reporter(settings.report_progress);
  CATENA_TRY(auto falcon,
             Falcon::open(std::make_unique<LibusbTransportSource>(kFalconUsbId, static_cast<int>(*index)), std::move(options)));
  return std::unique_ptr<Device>(std::move(falcon));
}

}  // namespace catena::haptics::usb
