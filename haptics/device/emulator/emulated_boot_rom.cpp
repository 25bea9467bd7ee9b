#include "haptics/device/emulator/emulated_boot_rom.h"

namespace catena::haptics {

BootStreamReader::State BootStreamReader::feed(std::uint8_t byte) {
  if (state_ != State::reading) return state_;
  if (low_ < 0) {
    low_ = byte;
    return state_;
  }
  const auto word = static_cast<std::uint16_t>(low_ | byte << 8);
  low_ = -1;
  return state_ = take(word);
}

BootStreamReader::State BootStreamReader::take(std::uint16_t word) {
  if (words_++ < kHeaderWords) return words_ == 1 && word != 0x08AA ? State::bad : State::reading;
  // a block: its size, two words of address, its data
  if (in_block_ == 0) {
    if (word == 0) return State::complete;
    block_words_ = std::size_t{2} + word;
    in_block_ = block_words_;
  } else {
    --in_block_;
  }
  return State::reading;
}

void EmulatedBootRom::reset() {
  state_ = State::asleep;
  heard_.clear();
}

void EmulatedBootRom::receive(std::uint8_t byte, std::uint16_t baud, bool dtr, std::vector<std::uint8_t>& answer) {
  if (state_ == State::asleep) {
    if (baud != kBaud9600) return;
    heard_.push_back(byte);
    const std::size_t n = heard_.size();
    if (n < 3 || heard_[n - 3] != 0x0A || heard_[n - 2] != 0x43 || heard_[n - 1] != 0x0D) return;
    heard_.clear();
    if (faults_.deaf_handshakes > 0) {
      --faults_.deaf_handshakes;
      return;
    }
    if (faults_.leading_zero) answer.push_back(0x00);
    answer.insert(answer.end(), {0x0A, 0x44, 0x2C, 0x0D});
    state_ = State::awake;
  } else if (state_ == State::awake) {
    if (baud != kBaudBoot || dtr || byte != 0x41) return;
    answer.push_back(0x41);
    state_ = State::loading;
    stream_ = {};
    image_bytes_ = 0;
    damaged_ = false;
    ++attempts_;
    error_at_ = npos;
    if (!faults_.echo_errors.empty()) {
      error_at_ = faults_.echo_errors.front();
      faults_.echo_errors.pop_front();
    }
  } else if (state_ == State::loading) {
    if (baud != kBaudBoot) return;
    const bool wrong = image_bytes_++ == error_at_;
    damaged_ = damaged_ || wrong;
    answer.push_back(wrong ? static_cast<std::uint8_t>(byte ^ 0x10) : byte);
    const auto stream = stream_.feed(byte);
    if (stream == BootStreamReader::State::bad) state_ = State::dead;
    if (stream == BootStreamReader::State::complete) state_ = damaged_ ? State::dead : State::started;
  }
}

}  // namespace catena::haptics
