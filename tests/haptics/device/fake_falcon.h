// SPDX-License-Identifier: MIT
/// A simulated Falcon in memory: a boot loader, then firmware that replies to each command with a frame. Tests set its faults and
/// read the commands that it received; `mutex` lets them do so while the driver's thread runs.
#pragma once
#include <atomic>
#include <chrono>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "haptics/device/usb/falcon_codec.h"
#include "haptics/device/usb/ftdi.h"
#include "tests/haptics/device/emulator/boot_image.h"

namespace catena::haptics::usb::test {

using Bytes = std::vector<std::uint8_t>;

/// A boot stream with one block of `words` words.
inline Bytes make_boot_image(int words = 200) { return tests::boot_image({words}); }

struct FakeFalcon {
  std::recursive_mutex mutex;

  // settings
  bool is_plugged = true;
  bool firmware_is_running = false;
  bool ignores_commands = false;          ///< true: replies to no command
  FalconFrame frame;                      ///< reply of the firmware
  Bytes garbage_before_frame;             ///< bytes in front of each frame
  std::vector<std::size_t> packet_sizes;  ///< payload sizes of the packets, used cyclically; empty: the maximum
  std::deque<UsbError> read_faults, write_faults, control_faults;
  Bytes handshake_reply{0x0A, 0x44, 0x2C, 0x0D};
  int ignored_handshakes = 0;                               ///< number of handshakes without a reply
  int corrupt_uploads = 0;                                  ///< number of uploads with a wrong echo
  std::size_t corrupt_byte = 100;                           ///< index of the wrong byte of the echo
  int failed_uploads = 0;                                   ///< number of uploads after which the firmware does not start
  Bytes image;                                              ///< image that starts the firmware
  bool echoes_all = false;                                  ///< true: the loader echoes every byte
  std::atomic<bool> block_reads{false}, is_blocked{false};  ///< reads block while `block_reads`; `is_blocked` reports it
  std::chrono::microseconds read_delay{0};                  ///< duration of a read

  // received requests and commands
  std::vector<std::pair<int, int>> controls;
  std::vector<FalconCommand> commands;
  int handshake_count = 0, upload_count = 0, in_halt_clears = 0, out_halt_clears = 0, open_count = 0;
  FalconCommand last() {
    const std::lock_guard lock(mutex);
    return commands.empty() ? FalconCommand{} : commands.back();
  }

  // internal state
  std::deque<std::uint8_t> output_queue;
  Bytes pending, received;
  int baud = 0;
  bool is_receiving_image = false;  ///< true: the loader waits for an image
  std::size_t packet_index = 0;

  template <class F>
  auto with_lock(F f) {
    const std::lock_guard lock(mutex);
    return f(*this);
  }
  void reply(std::span<const std::uint8_t> bytes) { output_queue.insert(output_queue.end(), bytes.begin(), bytes.end()); }
  void receive(std::span<const std::uint8_t> bytes) {
    if (echoes_all) reply(bytes);
    if (firmware_is_running) {
      pending.insert(pending.end(), bytes.begin(), bytes.end());
      FalconCommand command;
      while (pending.size() >= kFalconPacketBytes) {
        const bool is = baud == 0x02 && decode_command(std::span<const std::uint8_t>(pending).first<kFalconPacketBytes>(), command);
        pending.erase(pending.begin(), pending.begin() + (is ? kFalconPacketBytes : 1));
        if (!is) continue;
        commands.push_back(command);
        if (ignores_commands) continue;
        reply(garbage_before_frame);
        reply(encode_frame(frame));
      }
      return;
    }
    if (ignores_commands || echoes_all) return;
    if (baud == 0x4138 && Bytes(bytes.begin(), bytes.end()) == Bytes{0x0A, 0x43, 0x0D}) {
      is_receiving_image = false;
      received.clear();
      if (++handshake_count > ignored_handshakes) reply(handshake_reply);
      return;
    }
    if (baud != 0x15) return;
    for (const std::uint8_t byte : bytes) {
      if (!is_receiving_image) {
        is_receiving_image = byte == 0x41;
        if (is_receiving_image) {
          output_queue.push_back(byte);
          ++upload_count;
        }
        continue;
      }
      const bool spoilt = upload_count <= corrupt_uploads && received.size() == corrupt_byte;
      output_queue.push_back(static_cast<std::uint8_t>(spoilt ? byte ^ 0x10 : byte));
      received.push_back(byte);
      if (received == image) {
        is_receiving_image = false;
        firmware_is_running = upload_count > corrupt_uploads + failed_uploads;
      }
    }
  }
};

class FakeTransport final : public Transport {
 public:
  explicit FakeTransport(std::shared_ptr<FakeFalcon> falcon) : falcon_(std::move(falcon)) {}

  UsbError control(std::uint8_t request, std::uint16_t value) noexcept override {
    const std::lock_guard lock(falcon_->mutex);
    if (const UsbError fault = take(falcon_->control_faults); fault != UsbError::none) return fault;
    falcon_->controls.emplace_back(request, value);
    if (request == 3) falcon_->baud = value;
    if (request == 0 && value == 1) falcon_->output_queue.clear();
    return UsbError::none;
  }
  UsbTransferResult write(std::span<const std::uint8_t> bytes, int) noexcept override {
    const std::lock_guard lock(falcon_->mutex);
    if (const UsbError fault = take(falcon_->write_faults); fault != UsbError::none) return {fault, 0};
    falcon_->receive(bytes);
    return {UsbError::none, bytes.size()};
  }
  UsbTransferResult read(UsbPacket& packet, int) noexcept override {
    const auto pace = falcon_->with_lock([](FakeFalcon& f) { return f.read_delay; });
    if (pace.count() > 0) std::this_thread::sleep_for(pace);
    while (falcon_->block_reads) {
      falcon_->is_blocked = true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    const std::lock_guard lock(falcon_->mutex);
    if (const UsbError fault = take(falcon_->read_faults); fault != UsbError::none) return {fault, 0};
    packet[0] = 0x01;
    packet[1] = 0x60;
    std::size_t n = falcon_->packet_sizes.empty() ? 62 : falcon_->packet_sizes[falcon_->packet_index++ % falcon_->packet_sizes.size()];
    n = std::min(n, falcon_->output_queue.size());
    for (std::size_t i = 0; i < n; ++i) {
      packet[2 + i] = falcon_->output_queue.front();
      falcon_->output_queue.pop_front();
    }
    return {UsbError::none, n + 2};
  }
  UsbError clear_halt(UsbEndpoint endpoint) noexcept override {
    const std::lock_guard lock(falcon_->mutex);
    ++(endpoint == UsbEndpoint::in ? falcon_->in_halt_clears : falcon_->out_halt_clears);
    return falcon_->is_plugged ? UsbError::none : UsbError::disconnected;
  }

 private:
  UsbError take(std::deque<UsbError>& faults) {
    if (!falcon_->is_plugged || faults.empty()) return falcon_->is_plugged ? UsbError::none : UsbError::disconnected;
    const UsbError first = faults.front();
    faults.pop_front();
    return first;
  }
  std::shared_ptr<FakeFalcon> falcon_;
};

class FakeSource final : public TransportSource {
 public:
  explicit FakeSource(std::shared_ptr<FakeFalcon> falcon) : falcon_(std::move(falcon)) {}
  Result<std::unique_ptr<Transport>> open() override {
    const std::lock_guard lock(falcon_->mutex);
    if (!falcon_->is_plugged) return Error{"the fake Falcon is not on the USB bus; it was expected"};
    ++falcon_->open_count;
    falcon_->output_queue.clear();
    return std::unique_ptr<Transport>(std::make_unique<FakeTransport>(falcon_));
  }
  bool wait_for_arrival(int) noexcept override {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return false;
  }

 private:
  std::shared_ptr<FakeFalcon> falcon_;
};

}  // namespace catena::haptics::usb::test
