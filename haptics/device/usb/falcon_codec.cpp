// SPDX-License-Identifier: MIT
#include "haptics/device/usb/falcon_codec.h"

namespace catena::haptics::usb {
namespace {

constexpr std::uint8_t kFirst = '<', kLast = '>', kZero = 'A';  // 0x41

void put_counts(FalconPacket& packet, const FalconCounts& counts) noexcept {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto bits = static_cast<std::uint16_t>(counts[axis]);
    for (std::size_t nibble = 0; nibble < 4; ++nibble)
      packet[1 + 4 * axis + nibble] = static_cast<std::uint8_t>(kZero + ((bits >> (4 * nibble)) & 0xF));
  }
}

FalconCounts get_counts(std::span<const std::uint8_t, kFalconPacketBytes> bytes) noexcept {
  FalconCounts counts{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    unsigned bits = 0;
    for (std::size_t nibble = 0; nibble < 4; ++nibble) bits |= static_cast<unsigned>(bytes[1 + 4 * axis + nibble] - kZero) << (4 * nibble);
    counts[axis] = static_cast<std::int16_t>(static_cast<std::uint16_t>(bits));
  }
  return counts;
}

// Returns whether a byte may occur at position `at` of a device's frame.
bool fits(std::size_t at, std::uint8_t byte) noexcept {
  if (at == 0) return byte == kFirst;
  if (at <= 12) return byte >= kZero && byte < kZero + 16;
  if (at == 13) return byte >= kZero && byte < kZero + 0x80;
  return at == 14 || byte == kLast;
}

}  // namespace

FalconPacket encode_command(const FalconCommand& command) noexcept {
  FalconPacket packet{};
  packet[0] = kFirst;
  put_counts(packet, command.motors);
  packet[13] = static_cast<std::uint8_t>(kZero + (command.control & 0xF));
  packet[14] = kZero;
  packet[15] = kLast;
  return packet;
}

bool decode_command(std::span<const std::uint8_t, kFalconPacketBytes> bytes, FalconCommand& command) noexcept {
  for (std::size_t at = 0; at < kFalconPacketBytes; ++at)
    if (!fits(at, bytes[at])) return false;
  if (bytes[13] >= kZero + 16 || bytes[14] != kZero) return false;
  command.motors = get_counts(bytes);
  command.control = static_cast<std::uint8_t>(bytes[13] - kZero);
  return true;
}

FalconPacket encode_frame(const FalconFrame& frame) noexcept {
  FalconPacket packet{};
  packet[0] = kFirst;
  put_counts(packet, frame.encoders);
  packet[13] = static_cast<std::uint8_t>(kZero + (frame.buttons & 0xF) + ((frame.homed & 7) << 4));
  packet[14] = frame.unknown;
  packet[15] = kLast;
  return packet;
}

bool decode_frame(std::span<const std::uint8_t, kFalconPacketBytes> bytes, FalconFrame& frame) noexcept {
  for (std::size_t at = 0; at < kFalconPacketBytes; ++at)
    if (!fits(at, bytes[at])) return false;
  const unsigned bits = bytes[13] - kZero;
  frame.encoders = get_counts(bytes);
  frame.buttons = static_cast<std::uint8_t>(bits & 0xF);
  frame.homed = static_cast<std::uint8_t>(bits >> 4);
  frame.unknown = bytes[14];
  return true;
}

bool FalconFramer::push(std::uint8_t byte, FalconFrame& frame) noexcept {
  if (fits(buffered_, byte)) {
    bytes_[buffered_++] = byte;
    if (buffered_ < kFalconPacketBytes) return false;
    buffered_ = 0;
    return decode_frame(bytes_, frame);
  }
  // outside a frame: waits for its first byte
  if (buffered_ == 0) {
    ++dropped_bytes_;
    return false;
  }
  // inside a frame: only byte 14 can be the start of another frame; then `byte` is its second byte
  ++resyncs_;
  const bool restart = buffered_ == 15 && bytes_[14] == kFirst;
  dropped_bytes_ += restart ? 14 : buffered_;
  buffered_ = 0;
  if (restart) bytes_[buffered_++] = kFirst;
  if (fits(buffered_, byte)) {
    bytes_[buffered_++] = byte;
  } else {
    dropped_bytes_ += buffered_ + 1;
    buffered_ = 0;
    if (byte == kFirst) {
      bytes_[buffered_++] = byte;
      --dropped_bytes_;
    }
  }
  return false;
}

int FalconFramer::push(std::span<const std::uint8_t> bytes, FalconFrame& frame) noexcept {
  int frames = 0;
  for (const std::uint8_t byte : bytes) frames += push(byte, frame) ? 1 : 0;
  return frames;
}

}  // namespace catena::haptics::usb
