#include "haptics/device/emulator/emulated_transport.h"

#include <ctime>

#include "engine/base/clock.h"

namespace catena::haptics {
namespace {

void sleep_until_ns(std::int64_t at) noexcept {
  const timespec wake{static_cast<std::time_t>(at / 1000000000), static_cast<long>(at % 1000000000)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, nullptr) != 0) {
  }
}

}  // namespace

// on a grid of its own where it is kept, so that the mean rate is right
void EmulatedTransport::wait_for_bus(int ms) noexcept {
  if (!paced_) return;
  const std::int64_t now = now_ns(), wait = std::int64_t{1000000} * ms, next = last_ns_ + wait;
  if (next > now) sleep_until_ns(next);
  last_ns_ = next > now - wait ? next : now;
}

usb::UsbError EmulatedTransport::control(std::uint8_t request, std::uint16_t value) noexcept {
  const std::scoped_lock lock(shared_->mutex);
  if (!shared_->device.plugged()) return usb::UsbError::gone;
  return shared_->device.control({0x40, request, value, 0}) ? usb::UsbError::none : usb::UsbError::stall;
}

usb::UsbMoved EmulatedTransport::write(std::span<const std::uint8_t> bytes, int) noexcept {
  const std::scoped_lock lock(shared_->mutex);
  EmulatedFalcon& device = shared_->device;
  if (!device.plugged()) return {usb::UsbError::gone, 0};
  if (device.halted(EmulatedFalcon::kEndpointOut)) return {usb::UsbError::stall, 0};
  device.bulk_out(bytes);
  if (!device.plugged()) return {usb::UsbError::gone, 0};
  return {usb::UsbError::none, bytes.size()};
}

usb::UsbMoved EmulatedTransport::read(usb::UsbPacket& packet, int timeout_ms) noexcept {
  int wait_ms = 1;
  {
    const std::scoped_lock lock(shared_->mutex);
    if (!shared_->device.has_payload()) wait_ms = std::min(shared_->device.latency_ms(), timeout_ms);
  }
  wait_for_bus(wait_ms);
  const std::scoped_lock lock(shared_->mutex);
  EmulatedFalcon& device = shared_->device;
  if (!device.plugged()) return {usb::UsbError::gone, 0};
  if (device.halted(EmulatedFalcon::kEndpointIn)) return {usb::UsbError::stall, 0};
  if (!device.has_payload() && device.latency_ms() > timeout_ms) return {usb::UsbError::timeout, 0};
  return {usb::UsbError::none, device.bulk_in(packet)};
}

usb::UsbError EmulatedTransport::clear_halt(usb::UsbEndpoint endpoint) noexcept {
  const std::scoped_lock lock(shared_->mutex);
  if (!shared_->device.plugged()) return usb::UsbError::gone;
  shared_->device.clear_halt(endpoint == usb::UsbEndpoint::in ? EmulatedFalcon::kEndpointIn : EmulatedFalcon::kEndpointOut);
  return usb::UsbError::none;
}

Result<std::unique_ptr<usb::Transport>> EmulatedSource::open() {
  const std::scoped_lock lock(shared_->mutex);
  if (!shared_->device.plugged()) return Error{"emulated Falcon: it is unplugged"};
  return std::unique_ptr<usb::Transport>(std::make_unique<EmulatedTransport>(shared_, paced_));
}

bool EmulatedSource::wait_for_arrival(int timeout_ms) noexcept {
  {
    const std::scoped_lock lock(shared_->mutex);
    if (shared_->device.plugged()) return true;
  }
  sleep_until_ns(now_ns() + std::int64_t{1000000} * timeout_ms);
  return false;
}

}  // namespace catena::haptics
