// SPDX-License-Identifier: MIT
#include "haptics/device/emulator/emulated_transport.h"

#include <ctime>
#include <numbers>

#include "engine/base/clock.h"
#include "haptics/device/process/process_device.h"
#include "haptics/device/usb/falcon.h"
#include "haptics/device/usb/falcon_boot.h"

namespace catena::haptics {
namespace {

void sleep_until_ns(std::int64_t at) noexcept {
  const timespec wake{static_cast<std::time_t>(at / 1000000000), static_cast<long>(at % 1000000000)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, nullptr) != 0) {
  }
}

}  // namespace

// Waits for the emulated bus. Consecutive deadlines are equidistant as long as they are met, so that the mean rate is exact.
void EmulatedTransport::wait_for_bus(int ms) noexcept {
  if (!paced_) return;
  const std::int64_t now = now_ns(), wait = std::int64_t{1000000} * ms, next = last_ns_ + wait;
  if (next > now) sleep_until_ns(next);
  last_ns_ = next > now - wait ? next : now;
}

usb::UsbError EmulatedTransport::control(std::uint8_t request, std::uint16_t value) noexcept {
  const std::scoped_lock lock(shared_->mutex);
  if (!shared_->device.plugged()) return usb::UsbError::disconnected;
  return shared_->device.control({0x40, request, value, 0}) ? usb::UsbError::none : usb::UsbError::stall;
}

usb::UsbTransferResult EmulatedTransport::write(std::span<const std::uint8_t> bytes, int) noexcept {
  const std::scoped_lock lock(shared_->mutex);
  EmulatedFalcon& device = shared_->device;
  if (!device.plugged()) return {usb::UsbError::disconnected, 0};
  if (device.halted(EmulatedFalcon::kEndpointOut)) return {usb::UsbError::stall, 0};
  device.bulk_out(bytes);
  if (!device.plugged()) return {usb::UsbError::disconnected, 0};
  return {usb::UsbError::none, bytes.size()};
}

usb::UsbTransferResult EmulatedTransport::read(usb::UsbPacket& packet, int timeout_ms) noexcept {
  int wait_ms = 1;
  {
    const std::scoped_lock lock(shared_->mutex);
    if (!shared_->device.has_payload()) wait_ms = std::min(shared_->device.latency_ms(), timeout_ms);
  }
  wait_for_bus(wait_ms);
  const std::scoped_lock lock(shared_->mutex);
  EmulatedFalcon& device = shared_->device;
  if (!device.plugged()) return {usb::UsbError::disconnected, 0};
  if (device.halted(EmulatedFalcon::kEndpointIn)) return {usb::UsbError::stall, 0};
  if (!device.has_payload() && device.latency_ms() > timeout_ms) return {usb::UsbError::timeout, 0};
  return {usb::UsbError::none, device.bulk_in(packet)};
}

usb::UsbError EmulatedTransport::clear_halt(usb::UsbEndpoint endpoint) noexcept {
  const std::scoped_lock lock(shared_->mutex);
  if (!shared_->device.plugged()) return usb::UsbError::disconnected;
  shared_->device.clear_halt(endpoint == usb::UsbEndpoint::in ? EmulatedFalcon::kEndpointIn : EmulatedFalcon::kEndpointOut);
  return usb::UsbError::none;
}

Result<std::unique_ptr<usb::Transport>> EmulatedTransportSource::open() {
  const std::scoped_lock lock(shared_->mutex);
  if (!shared_->device.plugged()) return Error{"emulated Falcon: the device is unplugged"};
  return std::unique_ptr<usb::Transport>(std::make_unique<EmulatedTransport>(shared_, paced_));
}

bool EmulatedTransportSource::wait_for_arrival(int timeout_ms) noexcept {
  {
    const std::scoped_lock lock(shared_->mutex);
    if (shared_->device.plugged()) return true;
  }
  sleep_until_ns(now_ns() + std::int64_t{1000000} * timeout_ms);
  return false;
}

EmulatedUser gentle_user() {
  EmulatedUser hand;
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

EmulatedUser resting_user() {
  EmulatedUser hand;
  hand.path = {{0, {0, 0, 0.12}, 0},    {0.3, {0, 0, 0.12}, 0},  {1, {0, 0, 0.176}, 0}, {1.6, {0, 0, 0.13}, 0},
               {2.2, {0, 0, 0.176}, 0}, {2.5, {0, 0, 0.176}, 0}, {3, {0, 0, 0.12}, 0}};
  return hand;
}

void list_emulated_falcon(std::vector<DeviceInfo>& to) {
  to.push_back({"emulated-falcon", true, "the Falcon's driver with an emulated device in a simulated moving hand, without hardware"});
  to.push_back({"emulated-falcon:still", true, "the emulated Falcon in a hand that rests after homing, for devices test --forces"});
  to.push_back({"emulated-falcon:process", true,
                "the emulated Falcon in a separate process; emulated-falcon:process:FILE.csv and emulated-falcon:still:process:FILE.csv "
                "write the motor forces to a file"});
}

namespace {

/// Parts of a detail such as "still:process:FILE.csv".
struct EmulatedDetail {
  bool still = false, process = false, known = false;
  std::string table;
};

EmulatedDetail parse_detail(std::string_view text) {
  EmulatedDetail detail;
  const auto take = [&](std::string_view word) {
    if (!text.starts_with(word) || (text.size() > word.size() && text[word.size()] != ':')) return false;
    text.remove_prefix(std::min(text.size(), word.size() + 1));
    return true;
  };
  detail.still = take("still");
  detail.process = take("process");
  detail.known = text.empty() || detail.process;
  if (detail.process) detail.table = text;
  return detail;
}

}  // namespace

std::string emulated_falcon_table_path(const std::string& detail) { return parse_detail(detail).table; }

Result<std::unique_ptr<Device>> open_emulated_falcon(const std::string& text, const DeviceSettings& settings,
                                                     std::function<void(const EmulatedFalcon::Exchange&)> observer) {
  const EmulatedDetail detail = parse_detail(text);
  if (!detail.known)
    return Error{"\"emulated-falcon:" + text +
                 "\" is not known; \"emulated-falcon\", \"emulated-falcon:still\", \"emulated-falcon:process\" or "
                 "\"emulated-falcon:still:process\" was expected"};
  if (detail.process) return open_in_process(detail.still ? "emulated-falcon:still" : "emulated-falcon", detail.table, settings);
  usb::FalconOptions options;
  if (!settings.firmware.empty()) {
    CATENA_TRY(options.firmware, usb::read_falcon_image(settings.firmware));
  }
  options.boot.progress = usb::make_boot_progress_reporter(settings.report_progress);
  auto shared = std::make_shared<SharedEmulatedFalcon>(EmulatedFalconOptions{.firmware = settings.firmware.empty()});
  shared->device.mechanism().attach_user(detail.still ? resting_user() : gentle_user());
  if (observer) shared->device.set_exchange_observer(std::move(observer));
  options.force_gain = settings.force_gain;
  options.command_timeout_s = usb::falcon_command_timeout_s(settings.rate_hz);
  CATENA_TRY(std::unique_ptr<Device> device,
             usb::Falcon::open(std::make_unique<EmulatedTransportSource>(std::move(shared), true), std::move(options)));
  return device;
}

}  // namespace catena::haptics
