// SPDX-License-Identifier: MIT
#include "haptics/device/emulator/emulated_falcon.h"

#include <algorithm>

namespace catena::haptics {

BootStreamReader::State BootStreamReader::feed(std::uint8_t byte) {
  if (state_ != State::reading) return state_;
  if (low_byte_ < 0) {
    low_byte_ = byte;
    return state_;
  }
  const auto word = static_cast<std::uint16_t>(low_byte_ | byte << 8);
  low_byte_ = -1;
  return state_ = consume_word(word);
}

BootStreamReader::State BootStreamReader::consume_word(std::uint16_t word) {
  if (words_++ < kHeaderWords) return words_ == 1 && word != 0x08AA ? State::invalid : State::reading;
  // a block: its size, two words of address, then its data
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
  received_.clear();
}

void EmulatedBootRom::receive(std::uint8_t byte, std::uint16_t baud, bool dtr, std::vector<std::uint8_t>& response) {
  if (state_ == State::asleep) {
    if (baud != kBaud9600) return;
    received_.push_back(byte);
    const std::size_t n = received_.size();
    if (n < 3 || received_[n - 3] != 0x0A || received_[n - 2] != 0x43 || received_[n - 1] != 0x0D) return;
    received_.clear();
    if (faults_.ignored_handshakes > 0) {
      --faults_.ignored_handshakes;
      return;
    }
    if (faults_.leading_zero) response.push_back(0x00);
    response.insert(response.end(), {0x0A, 0x44, 0x2C, 0x0D});
    state_ = State::awake;
  } else if (state_ == State::awake) {
    if (baud != kBaudBoot || dtr || byte != 0x41) return;
    response.push_back(0x41);
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
    response.push_back(wrong ? static_cast<std::uint8_t>(byte ^ 0x10) : byte);
    const auto stream = stream_.feed(byte);
    if (stream == BootStreamReader::State::invalid) state_ = State::dead;
    if (stream == BootStreamReader::State::complete) state_ = damaged_ ? State::dead : State::started;
  }
}

namespace {

constexpr std::size_t kFrame = 16;
constexpr std::uint8_t kNibble = 0x41;
constexpr std::size_t kChipBuffer = 256;  ///< capacity of the chip's buffer toward the host, bytes
constexpr std::size_t kControlsKept = 4096;

void put_int16(std::vector<std::uint8_t>& to, int value) {
  for (int shift = 0; shift < 16; shift += 4) to.push_back(static_cast<std::uint8_t>(kNibble + (value >> shift & 15)));
}

// Decodes four nibbles, the low one first. Returns false if a byte is not a nibble.
bool get_int16(const std::uint8_t* from, int& value) {
  unsigned bits = 0;
  for (unsigned i = 0; i < 4; ++i) {
    if (from[i] < kNibble || from[i] > kNibble + 15) return false;
    bits |= static_cast<unsigned>(from[i] - kNibble) << (4 * i);
  }
  value = static_cast<std::int16_t>(bits);
  return true;
}

}  // namespace

EmulatedFalcon::EmulatedFalcon(const EmulatedFalconOptions& options)
    : options_(options), mechanism_(options.power_on_offset), running_(options.firmware) {
  if (options.homed) mechanism_.set_homed();
}

void EmulatedFalcon::plug(bool stays_powered) {
  plugged_ = true;
  to_host_.clear();
  pending_reply_.clear();
  frame_.clear();
  baud_ = kBaud9600;
  latency_ms_ = 16;
  dtr_ = true;
  halted_[0] = halted_[1] = false;
  if (stays_powered) return;
  running_ = false;
  boot_rom_.reset();
  mechanism_.power_off(options_.power_on_offset);
}

bool EmulatedFalcon::control(const UsbControl& request) {
  if (controls_.size() < kControlsKept) controls_.push_back(request);
  if (request.request_type != 0x40 || request.index != 0) return false;
  switch (request.request) {
    case 0:
      if (request.value > 2) return false;
      if (request.value != 2) {
        to_host_.clear();
        pending_reply_.clear();
      }
      if (request.value != 1) frame_.clear();
      return true;
    case 1:
      if ((request.value & 0x0100) != 0) {
        const bool dtr = (request.value & 1) != 0;
        // a rising edge of DTR resets the processor into its boot ROM
        if (dtr && !dtr_) {
          running_ = false;
          boot_rom_.reset();
          mechanism_.power_off(options_.power_on_offset);
        }
        dtr_ = dtr;
      }
      return true;
    case 2:
      return request.value == 0;
    case 3:
      if (request.value != kBaud9600 && request.value != kBaudBoot && request.value != kBaudRunning) return false;
      baud_ = request.value;
      return true;
    case 4:
      return request.value == 8;
    case 9:
      if (request.value < 1 || request.value > 255) return false;
      latency_ms_ = request.value;
      return true;
    default:
      return false;
  }
}

void EmulatedFalcon::bulk_out(std::span<const std::uint8_t> bytes) {
  std::vector<std::uint8_t> response;  // bytes that the boot ROM sends back
  for (const std::uint8_t byte : bytes) {
    if (!plugged_) return;
    ++out_bytes_;
    if (faults_.unplug_after_out_bytes > 0 && out_bytes_ >= faults_.unplug_after_out_bytes) {
      faults_.unplug_after_out_bytes = 0;
      unplug();
      return;
    }
    if (running_) {
      receive(byte);
      continue;
    }
    boot_rom_.receive(byte, baud_, dtr_, response);
    running_ = boot_rom_.started();
  }
  send(response);
}

void EmulatedFalcon::receive(std::uint8_t byte) {
  if (baud_ != kBaudRunning) {
    if (faults_.garbage_at_wrong_baud) send({static_cast<std::uint8_t>(byte | 0xC0)});
    return;
  }
  if (frame_.empty() && byte != '<') {
    ++bad_bytes_;
    return;
  }
  frame_.push_back(byte);
  if (frame_.size() < kFrame) return;
  if (frame_[14] == 'A' && frame_[15] == '>') {
    answer_frame();
    frame_.clear();
    return;
  }
  // out of sync: restarts at the next framing byte
  const auto next = std::find(frame_.begin() + 1, frame_.end(), '<');
  bad_bytes_ += static_cast<std::uint64_t>(next - frame_.begin());
  frame_.erase(frame_.begin(), next);
}

void EmulatedFalcon::answer_frame() {
  Exchange exchange;
  for (std::size_t i = 0; i < 3; ++i)
    if (!get_int16(&frame_[1 + 4 * i], exchange.motors[i])) {
      bad_bytes_ += kFrame;
      return;
    }
  exchange.control = (frame_[13] - unsigned{kNibble}) & 15u;
  ++frames_;
  exchange.force_n = compute_motor_force(mechanism_.legs(), exchange.motors);
  mechanism_.advance(options_.seconds_per_frame, exchange.motors, (exchange.control & 1u) != 0);
  exchange.encoders = mechanism_.encoders();
  exchange.position_m = mechanism_.position_m();
  exchange.homed = mechanism_.homed_bits();
  last_exchange_ = exchange;
  if (observer_) observer_(exchange);

  std::vector<std::uint8_t> reply{'<'};
  for (const int count : exchange.encoders) put_int16(reply, std::clamp(count, -32768, 32767));
  reply.push_back(static_cast<std::uint8_t>(kNibble + ((mechanism_.buttons() & 15u) | exchange.homed << 4)));
  reply.push_back('A');
  reply.push_back('>');
  ReplyFault fault;
  if (!faults_.replies.empty()) {
    fault = faults_.replies.front();
    faults_.replies.pop_front();
  }
  if (fault.kind == ReplyFault::Kind::drop) return;
  if (fault.kind == ReplyFault::Kind::truncate) reply.resize(std::min(fault.byte_count, reply.size()));
  if (fault.kind == ReplyFault::Kind::garbage) {
    static constexpr std::uint8_t kNoise[] = {'<', 0x00, 'J', '>', 0xFF, '<', 'A', 'A', '<', 'P', 0x7F};
    std::vector<std::uint8_t> noise;
    for (std::size_t i = 0; i < fault.byte_count; ++i) noise.push_back(kNoise[i % std::size(kNoise)]);
    reply.insert(reply.begin(), noise.begin(), noise.end());
  }
  if (fault.kind == ReplyFault::Kind::join) {
    pending_reply_.insert(pending_reply_.end(), reply.begin(), reply.end());
    return;
  }
  reply.insert(reply.begin(), pending_reply_.begin(), pending_reply_.end());
  pending_reply_.clear();
  if (fault.kind == ReplyFault::Kind::split && fault.byte_count < reply.size()) {
    const auto at = reply.begin() + static_cast<std::ptrdiff_t>(fault.byte_count);
    send({reply.begin(), at});
    send({at, reply.end()});
    return;
  }
  send(reply);
}

void EmulatedFalcon::send(const std::vector<std::uint8_t>& bytes) {
  if (faults_.silent || bytes.empty()) return;
  // data that the chip cannot buffer is lost if the host does not read
  std::size_t waiting = bytes.size();
  for (const auto& chunk : to_host_) waiting += chunk.size();
  if (waiting > kChipBuffer)
    ++overruns_;
  else
    to_host_.push_back(bytes);
}

std::size_t EmulatedFalcon::bulk_in(std::span<std::uint8_t, kPacket> packet) {
  packet[0] = 0x01;
  packet[1] = 0x60;
  if (to_host_.empty()) return 2;
  std::vector<std::uint8_t>& front = to_host_.front();
  const std::size_t n = std::min(front.size(), kPayload);
  std::copy_n(front.begin(), n, packet.begin() + 2);
  front.erase(front.begin(), front.begin() + static_cast<std::ptrdiff_t>(n));
  if (front.empty()) to_host_.pop_front();
  return 2 + n;
}

}  // namespace catena::haptics
