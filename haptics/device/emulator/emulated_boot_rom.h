/// The boot ROM of the emulated Falcon's processor: wakes on a handshake, echoes a boot stream, starts what it has loaded.
///   1. at 9600 baud  0A 43 0D -> 0A 44 2C 0D   2. at 142857 baud, DTR low  41 -> 41   3. every image byte is echoed
/// Boot stream: LSB-first 16-bit words: key 0x08AA, 8 reserved, entry (high, low), blocks {size, address high, low, data}, size 0.
/// A stream with another key, or one that was damaged on the wire, never starts: reset and load again.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

namespace catena::haptics {

inline constexpr std::uint16_t kBaud9600 = 0x4138, kBaudBoot = 0x15, kBaudRunning = 0x02;

/// Reads a boot stream byte by byte.
class BootStreamReader {
 public:
  enum class State { reading, complete, bad };
  State feed(std::uint8_t byte);
  std::size_t words() const { return words_; }

 private:
  static constexpr std::size_t kHeaderWords = 1 + 8 + 2;
  State take(std::uint16_t word);
  State state_ = State::reading;
  std::size_t words_ = 0, in_block_ = 0, block_words_ = 0;
  int low_ = -1;
};

class EmulatedBootRom {
 public:
  struct Faults {
    int deaf_handshakes = 0;              ///< so many handshakes get no answer
    bool leading_zero = false;            ///< the answer starts with a 00, as on some systems
    std::deque<std::size_t> echo_errors;  ///< one an attempt: the image byte that is damaged; npos: none in that attempt
  };
  static constexpr std::size_t npos = static_cast<std::size_t>(-1);

  void reset();
  /// What the ROM answers to a byte that came at this baud rate.
  void receive(std::uint8_t byte, std::uint16_t baud, bool dtr, std::vector<std::uint8_t>& answer);
  bool started() const { return state_ == State::started; }  ///< the loaded program runs

  Faults& faults() { return faults_; }
  int attempts() const { return attempts_; }                ///< images begun
  std::size_t image_bytes() const { return image_bytes_; }  ///< of the last attempt

 private:
  enum class State { asleep, awake, loading, dead, started };
  State state_ = State::asleep;
  Faults faults_;
  BootStreamReader stream_;
  std::vector<std::uint8_t> heard_;
  std::size_t image_bytes_ = 0, error_at_ = npos;
  int attempts_ = 0;
  bool damaged_ = false;
};

}  // namespace catena::haptics
