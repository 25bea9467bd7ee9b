// SPDX-License-Identifier: MIT
/// The Novint Falcon's two packets, 16 bytes each, both of the form  '<' 12 nibbles  byte  byte '>'.
///   to the device:   '<', three int16 motor counts (4 nibbles each, low one first), control, 'A', '>'; bytes 1-14 are value + 0x41
///   from the device: the same with three int16 encoder counts; byte 13 - 0x41: bits 0-3 buttons, bits 4-6 homed per axis
///                    (so it reaches 0xC0); byte 14 has no known meaning
/// Frames arrive split, joined, short or with garbage between them: the framer finds them by their framing bytes and accepts
/// a frame only if every byte is valid at its position. Pure, no allocation, any thread.
#pragma once
#include <array>
#include <cstdint>
#include <span>

namespace catena::haptics::usb {

inline constexpr std::size_t kFalconPacketBytes = 16;
using FalconPacket = std::array<std::uint8_t, kFalconPacketBytes>;
using FalconCounts = std::array<std::int16_t, 3>;

/// Bits of the control byte.
enum FalconControl : std::uint8_t { kFalconHoming = 0x01, kFalconGreen = 0x02, kFalconBlue = 0x04, kFalconRed = 0x08 };

/// Bits of FalconFrame::buttons.
enum FalconButton : std::uint8_t { kFalconPlus = 1, kFalconForward = 2, kFalconCenter = 4, kFalconMinus = 8 };

/// Packet to the device.
struct FalconCommand {
  FalconCounts motors{};     ///< +-4095 is full torque
  std::uint8_t control = 0;  ///< bits of FalconControl; four bits
};

/// Packet from the device.
struct FalconFrame {
  FalconCounts encoders{};
  std::uint8_t buttons = 0;  ///< bits of FalconButton
  std::uint8_t homed = 0;    ///< bits 0-2, one per axis
  std::uint8_t unknown = 0;  ///< byte 14, as received

  bool all_homed() const { return homed == 7; }
};

/// Returns the packet of a command.
FalconPacket encode_command(const FalconCommand& command) noexcept;
/// Decodes a packet as the device (or its emulator) does; false: not a valid command.
bool decode_command(std::span<const std::uint8_t, kFalconPacketBytes> bytes, FalconCommand& command) noexcept;

/// Returns the packet of a frame, as the device (or its emulator) sends it.
FalconPacket encode_frame(const FalconFrame& frame) noexcept;
/// Decodes one whole frame; false: not a valid frame.
bool decode_frame(std::span<const std::uint8_t, kFalconPacketBytes> bytes, FalconFrame& frame) noexcept;

/// Extracts frames from a byte stream that arrives in chunks of any length. Holds at most 15 bytes between calls.
class FalconFramer {
 public:
  /// Adds a byte. True: `frame` is a new frame that ends with this byte.
  bool push(std::uint8_t byte, FalconFrame& frame) noexcept;
  /// Adds all of `bytes`; returns how many frames they completed, the newest in `frame`.
  int push(std::span<const std::uint8_t> bytes, FalconFrame& frame) noexcept;
  /// Discards an incomplete frame.
  void reset() noexcept { buffered_ = 0; }

  std::uint64_t dropped_bytes() const { return dropped_bytes_; }  ///< bytes that belonged to no frame
  std::uint64_t resyncs() const { return resyncs_; }              ///< number of incomplete frames that were discarded

 private:
  FalconPacket bytes_{};
  std::size_t buffered_ = 0;
  std::uint64_t dropped_bytes_ = 0, resyncs_ = 0;
};

}  // namespace catena::haptics::usb
