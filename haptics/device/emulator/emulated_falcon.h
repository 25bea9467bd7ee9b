// SPDX-License-Identifier: MIT
/// The boot ROM of the emulated Falcon's processor: responds to a handshake, echoes a boot stream, starts the loaded program.
///   1. at 9600 baud  0A 43 0D -> 0A 44 2C 0D   2. at 142857 baud, DTR low  41 -> 41   3. every image byte is echoed
/// Boot stream: LSB-first 16-bit words: key 0x08AA, 8 reserved, entry (high, low), blocks {size, address high, low, data}, size 0.
/// A stream with another key, or one that was corrupted in transfer, never starts: reset and load again.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <vector>

#include "haptics/device/emulator/emulated_mechanism.h"

namespace catena::haptics {

/// Baud-rate divisors of the FTDI chip.
inline constexpr std::uint16_t kBaud9600 = 0x4138, kBaudBoot = 0x15, kBaudRunning = 0x02;

/// Parser of a boot stream, byte by byte.
class BootStreamReader {
 public:
  /// State of the parser: more bytes are expected, the stream is complete, or it is invalid.
  enum class State { reading, complete, invalid };
  State feed(std::uint8_t byte);
  std::size_t words() const { return words_; }

 private:
  static constexpr std::size_t kHeaderWords = 1 + 8 + 2;
  State consume_word(std::uint16_t word);
  State state_ = State::reading;
  std::size_t words_ = 0, in_block_ = 0, block_words_ = 0;
  int low_byte_ = -1;
};

/// The boot ROM.
class EmulatedBootRom {
 public:
  /// Faults to inject.
  struct Faults {
    int ignored_handshakes = 0;           ///< number of handshakes without an answer
    bool leading_zero = false;            ///< the answer starts with a 00, as on some systems
    std::deque<std::size_t> echo_errors;  ///< one per attempt: index of the image byte that is corrupted; npos: none in that attempt
  };
  static constexpr std::size_t npos = static_cast<std::size_t>(-1);

  void reset();
  /// Appends to `response` the ROM's response to a byte received at this baud rate.
  void receive(std::uint8_t byte, std::uint16_t baud, bool dtr, std::vector<std::uint8_t>& response);
  bool started() const { return state_ == State::started; }  ///< the loaded program runs

  Faults& faults() { return faults_; }
  int attempts() const { return attempts_; }                ///< images begun
  std::size_t image_bytes() const { return image_bytes_; }  ///< bytes of the last attempt

 private:
  enum class State { asleep, awake, loading, dead, started };
  State state_ = State::asleep;
  Faults faults_;
  BootStreamReader stream_;
  std::vector<std::uint8_t> received_;
  std::size_t image_bytes_ = 0, error_at_ = npos;
  int attempts_ = 0;
  bool damaged_ = false;
};

/// A Novint Falcon without hardware, at the level of its USB endpoints: the FTDI chip (control requests, packets of 64 bytes with two
/// bytes of modem status, baud rates), the boot ROM, the firmware's I/O frames, the mechanism. It does not use libusb: tests put the
/// real libusb in front of it, and EmulatedTransport only the driver.
///   frame to the device:  '<' 3 x int16 motors, control, 'A', '>'      from it:  '<' 3 x int16 encoders, bits, 'A', '>'
///   (an int16 is four bytes 0x41 + nibble, low nibble first). Each frame advances the mechanism by `seconds_per_frame`.
/// Deterministic: its behavior depends only on what it is sent. Not thread-safe: its owner locks. Written from the protocol's
/// description, independently of the driver. Faults are injected on demand: see EmulatedFaults.
///
/// Options of an EmulatedFalcon.
struct EmulatedFalconOptions {
  bool firmware = true;  ///< the firmware runs already; false: the boot ROM waits for an image
  bool homed = false;
  double seconds_per_frame = 1e-3;
  EmulatedMechanism::Counts power_on_offset{700, -450, 300};
};

/// A USB control request.
struct UsbControl {
  std::uint8_t request_type = 0, request = 0;
  std::uint16_t value = 0, index = 0;
  friend bool operator==(const UsbControl&, const UsbControl&) = default;
};

/// Fault applied to one reply frame on its way to the host.
struct ReplyFault {
  /// Kind of fault; n is byte_count.
  enum class Kind {
    none,
    split,     ///< after n bytes, over two packets
    join,      ///< delayed, and sent in the packet of the next reply
    truncate,  ///< only the first n bytes
    garbage,   ///< n foreign bytes before it, framing bytes among them
    drop
  };
  Kind kind = Kind::none;
  std::size_t byte_count = 0;
};

/// Faults to inject.
struct EmulatedFaults {
  std::deque<ReplyFault> replies;            ///< one per reply, in order; none after the last
  bool silent = false;                       ///< the processor sends nothing, the chip continues
  bool garbage_at_wrong_baud = false;        ///< false: bytes at a wrong baud rate are ignored
  std::uint64_t unplug_after_out_bytes = 0;  ///< > 0: unplugged after so many bytes were received
};

/// The emulated Falcon.
class EmulatedFalcon {
 public:
  static constexpr std::uint16_t kVendor = 0x0403, kProduct = 0xcb48;
  static constexpr std::uint8_t kEndpointOut = 0x02, kEndpointIn = 0x81;
  static constexpr std::size_t kPacket = 64, kPayload = 62;

  /// One I/O frame as seen by the device: the command received, and the answer.
  struct Exchange {
    EmulatedMechanism::Counts motors{}, encoders{};
    Vec3 position_m{0.0};  ///< position of the grip when the encoders were read
    Vec3 force_n{0.0};     ///< force of the motors at the grip's position when the command was received
    unsigned control = 0;  ///< bits: 1 homing, 2 green, 4 blue, 8 red
    unsigned homed = 0;
  };

  explicit EmulatedFalcon(const EmulatedFalconOptions& options = {});

  // USB endpoints
  bool control(const UsbControl& request);  ///< false: STALL
  void bulk_out(std::span<const std::uint8_t> bytes);
  bool has_payload() const { return !to_host_.empty(); }
  std::size_t bulk_in(std::span<std::uint8_t, kPacket> packet);  ///< one packet: 2 bytes of status, and the payload available
  void halt(std::uint8_t endpoint) { halted_[endpoint == kEndpointIn] = true; }
  void clear_halt(std::uint8_t endpoint) { halted_[endpoint == kEndpointIn] = false; }
  bool halted(std::uint8_t endpoint) const { return halted_[endpoint == kEndpointIn]; }
  bool plugged() const { return plugged_; }
  void unplug() { plugged_ = false; }
  /// Plugs the device in. Without power in between the firmware and the homing are lost, and the boot ROM waits.
  void plug(bool stays_powered);

  EmulatedFaults& faults() { return faults_; }
  EmulatedBootRom& boot_rom() { return boot_rom_; }
  EmulatedMechanism& mechanism() { return mechanism_; }
  const EmulatedMechanism& mechanism() const { return mechanism_; }

  // counters and state, for tests
  const std::vector<UsbControl>& controls() const { return controls_; }
  const Exchange& last_exchange() const { return last_exchange_; }
  std::uint64_t frames() const { return frames_; }        ///< complete frames received
  std::uint64_t bad_bytes() const { return bad_bytes_; }  ///< received bytes that belonged to no frame, while the firmware ran
  std::uint64_t out_bytes() const { return out_bytes_; }
  std::uint64_t overruns() const { return overruns_; }  ///< replies lost because the host did not read
  int latency_ms() const { return latency_ms_; }
  std::uint16_t baud() const { return baud_; }
  bool running() const { return running_; }
  /// Sets a function that is called for every frame received, on the thread that calls bulk_out.
  void set_exchange_observer(std::function<void(const Exchange&)> observer) { observer_ = std::move(observer); }

 private:
  void receive(std::uint8_t byte);
  void answer_frame();
  void send(const std::vector<std::uint8_t>& bytes);

  EmulatedFalconOptions options_;
  EmulatedMechanism mechanism_;
  EmulatedBootRom boot_rom_;
  EmulatedFaults faults_;
  std::deque<std::vector<std::uint8_t>> to_host_;  ///< each is one packet's payload, or more
  std::vector<std::uint8_t> pending_reply_;        ///< reply that is delayed until the next one
  std::vector<std::uint8_t> frame_;                ///< received bytes of an incomplete frame
  std::vector<UsbControl> controls_;
  std::function<void(const Exchange&)> observer_;
  Exchange last_exchange_;
  std::uint64_t frames_ = 0, bad_bytes_ = 0, out_bytes_ = 0, overruns_ = 0;
  std::uint16_t baud_ = kBaud9600;
  int latency_ms_ = 16;
  bool dtr_ = true, running_, plugged_ = true;
  bool halted_[2] = {false, false};
};

}  // namespace catena::haptics
