/// A Novint Falcon without hardware, seen from its USB endpoints: the FTDI chip (control requests, packets of 64 bytes with two
/// bytes of modem status, baud rates), the boot ROM, the firmware's I/O frames, the mechanism. No libusb in it: tests put the
/// real libusb in front of it, and EmulatedTransport the driver alone.
///   frame to the device:  '<' 3 x int16 motors, control, 'A', '>'      from it:  '<' 3 x int16 encoders, bits, 'A', '>'
///   (an int16 is four bytes 0x41 + nibble, low nibble first). Each frame moves the mechanism on by `seconds_per_frame`.
/// Deterministic: what it does depends only on what it is sent. Not thread-safe: its owner locks. Written from the protocol's
/// description, not from the driver. Faults are made on demand: see EmulatedFaults.
#pragma once
#include <deque>
#include <functional>
#include <span>

#include "haptics/device/emulator/emulated_boot_rom.h"
#include "haptics/device/emulator/emulated_mechanism.h"

namespace catena::haptics {

struct EmulatedFalconOptions {
  bool firmware = true;  ///< runs already; else the boot ROM waits for an image
  bool homed = false;
  double seconds_per_frame = 1e-3;
  EmulatedMechanism::Counts power_on_offset{700, -450, 300};
};

struct UsbControl {
  std::uint8_t request_type = 0, request = 0;
  std::uint16_t value = 0, index = 0;
  friend bool operator==(const UsbControl&, const UsbControl&) = default;
};

/// What becomes of one reply frame on its way to the host.
struct ReplyFault {
  enum class Kind {
    none,
    split,     ///< after n bytes, over two packets
    join,      ///< waits for the next reply, and comes in its packet
    truncate,  ///< only the first n bytes
    garbage,   ///< n bytes that belong to nothing before it, framing bytes among them
    drop
  };
  Kind kind = Kind::none;
  std::size_t n = 0;
};

struct EmulatedFaults {
  std::deque<ReplyFault> replies;            ///< one a reply, in order; none after the last
  bool silent = false;                       ///< the processor says nothing, the chip goes on
  bool garbage_at_wrong_baud = false;        ///< else a wrong baud rate is heard as nothing
  std::uint64_t unplug_after_out_bytes = 0;  ///< > 0: gone once so many bytes have come
};

class EmulatedFalcon {
 public:
  static constexpr std::uint16_t kVendor = 0x0403, kProduct = 0xcb48;
  static constexpr std::uint8_t kEndpointOut = 0x02, kEndpointIn = 0x81;
  static constexpr std::size_t kPacket = 64, kPayload = 62;

  /// One I/O frame, as the device saw it: what it was sent, and what it answered.
  struct Exchange {
    EmulatedMechanism::Counts motors{}, encoders{};
    Vec3 position_m{0.0};  ///< of the grip, when the encoders were read
    Vec3 force_n{0.0};     ///< of the motors, where the grip was when they came
    unsigned control = 0;  ///< bits: 1 homing, 2 green, 4 blue, 8 red
    unsigned homed = 0;
  };

  explicit EmulatedFalcon(const EmulatedFalconOptions& options = {});

  // the wire
  bool control(const UsbControl& request);  ///< false: STALL
  void bulk_out(std::span<const std::uint8_t> bytes);
  bool has_payload() const { return !to_host_.empty(); }
  std::size_t bulk_in(std::span<std::uint8_t, kPacket> packet);  ///< one packet: 2 bytes of status, and what there is
  void halt(std::uint8_t endpoint) { halted_[endpoint == kEndpointIn] = true; }
  void clear_halt(std::uint8_t endpoint) { halted_[endpoint == kEndpointIn] = false; }
  bool halted(std::uint8_t endpoint) const { return halted_[endpoint == kEndpointIn]; }
  bool plugged() const { return plugged_; }
  void unplug() { plugged_ = false; }
  /// Without power in between the firmware and the homing are lost, and the boot ROM waits.
  void plug(bool power_kept);

  EmulatedFaults& faults() { return faults_; }
  EmulatedBootRom& boot_rom() { return boot_rom_; }
  EmulatedMechanism& mechanism() { return mechanism_; }
  const EmulatedMechanism& mechanism() const { return mechanism_; }

  // what has happened
  const std::vector<UsbControl>& controls() const { return controls_; }
  const Exchange& last() const { return last_; }
  std::uint64_t frames() const { return frames_; }        ///< whole frames that came
  std::uint64_t bad_bytes() const { return bad_bytes_; }  ///< that came and belonged to no frame, while the firmware ran
  std::uint64_t out_bytes() const { return out_bytes_; }
  std::uint64_t overruns() const { return overruns_; }  ///< replies lost because the host did not read
  int latency_ms() const { return latency_ms_; }
  std::uint16_t baud() const { return baud_; }
  bool running() const { return running_; }
  /// Called for every frame that came, in the caller of bulk_out.
  void on_exchange(std::function<void(const Exchange&)> observer) { observer_ = std::move(observer); }

 private:
  void receive(std::uint8_t byte);
  void answer_frame();
  void send(const std::vector<std::uint8_t>& bytes);

  EmulatedFalconOptions options_;
  EmulatedMechanism mechanism_;
  EmulatedBootRom boot_rom_;
  EmulatedFaults faults_;
  std::deque<std::vector<std::uint8_t>> to_host_;  ///< each is a packet's payload, or more
  std::vector<std::uint8_t> held_;                 ///< a reply that waits for the next one
  std::vector<std::uint8_t> frame_;                ///< what has come of one
  std::vector<UsbControl> controls_;
  std::function<void(const Exchange&)> observer_;
  Exchange last_;
  std::uint64_t frames_ = 0, bad_bytes_ = 0, out_bytes_ = 0, overruns_ = 0;
  std::uint16_t baud_ = kBaud9600;
  int latency_ms_ = 16;
  bool dtr_ = true, running_, plugged_ = true;
  bool halted_[2] = {false, false};
};

}  // namespace catena::haptics
