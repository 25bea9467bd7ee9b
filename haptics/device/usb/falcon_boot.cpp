// SPDX-License-Identifier: MIT
#include "haptics/device/usb/falcon_boot.h"

#include <fmt/format.h>
#include <filesystem>
#include <string_view>

#include "engine/base/text.h"

namespace catena::haptics::usb {
namespace {

constexpr std::size_t kHeaderBytes = 22, kBlockHeaderBytes = 6;
constexpr std::uint32_t kAddressEnd = 1u << 22;
constexpr unsigned kKey = 0x08AA;

Error error_at(const std::string& name, std::size_t offset, const std::string& what) {
  return Error{fmt::format("{}: byte {}: {}; a Falcon firmware image (a TI C2000 boot stream) was expected", one_line(name), offset, what)};
}

}  // namespace

Result<FalconImageInfo> check_falcon_image(std::span<const std::uint8_t> image, const std::string& name) {
  const auto word = [image](std::size_t at) { return static_cast<std::uint32_t>(image[at] | (image[at + 1] << 8)); };
  if (image.size() > kFalconImageMaxBytes)
    return error_at(name, kFalconImageMaxBytes,
                    fmt::format("the firmware image is too long, {} bytes; at most {} were expected", image.size(), kFalconImageMaxBytes));
  if (image.size() % 2 != 0) return error_at(name, image.size(), "the image ends with half a word; an even number of bytes was expected");
  if (image.size() < 2) return error_at(name, 0, "the image is empty; the key 0x08AA was expected");
  if (word(0) != kKey) return error_at(name, 0, fmt::format("found 0x{:04X}; the key 0x08AA was expected", word(0)));
  if (image.size() < kHeaderBytes)
    return error_at(name, image.size(), fmt::format("the image ends inside the header of {} bytes", kHeaderBytes));
  FalconImageInfo info;
  info.entry = (word(18) << 16) | word(20);
  if (info.entry >= kAddressEnd)
    return error_at(name, 18, fmt::format("the entry address is 0x{:X}; an address below 0x400000 was expected", info.entry));

  std::size_t at = kHeaderBytes;
  while (true) {
    if (at + 2 > image.size()) return error_at(name, at, "the image ends; the size of a block or the final 0 was expected");
    const std::size_t words = word(at);
    if (words == 0) break;
    if (at + kBlockHeaderBytes > image.size()) return error_at(name, at + 2, "the image ends; the address of a block was expected");
    const std::size_t address = (std::size_t{word(at + 2)} << 16) | word(at + 4), left = image.size() - at - kBlockHeaderBytes;
    if (address + words > kAddressEnd)
      return error_at(name, at + 2, fmt::format("a block has {} words at 0x{:X}; an end below 0x400000 was expected", words, address));
    if (2 * words > left)
      return error_at(
          name, at,
          fmt::format("a block has {} bytes, but only {} bytes are left; the file is truncated, or not an image", 2 * words, left));
    at += kBlockHeaderBytes + 2 * words;
    info.data_words += words;
    ++info.blocks;
  }
  if (info.blocks == 0) return error_at(name, kHeaderBytes, "found the final 0; a first block was expected");
  if (at + 2 != image.size())
    return error_at(name, at + 2, fmt::format("{} bytes follow the final 0; the end was expected", image.size() - at - 2));
  return info;
}

Result<std::vector<std::uint8_t>> read_falcon_image(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored))
    return Error{one_line(path) + ": this is not a file; a Falcon firmware image was expected"};
  // the size is checked before the file is read
  const std::uintmax_t size = std::filesystem::file_size(path, ignored);
  if (!ignored && size > kFalconImageMaxBytes)
    return error_at(path, kFalconImageMaxBytes,
                    fmt::format("the firmware image is too long, {} bytes; at most {} were expected", size, kFalconImageMaxBytes));
  CATENA_TRY(const std::string text, read_text_file(path, "a Falcon firmware image"));
  std::vector<std::uint8_t> image(text.begin(), text.end());
  CATENA_CHECK(check_falcon_image(image, path));
  return image;
}

namespace {

constexpr int kBootWriteMs = 500, kBootReadMs = 100;
constexpr int kProbeReads = 10, kProbeReadMs = 20;
constexpr int kHandshakeReads = 4, kEchoIdleReads = 20;  // an idle device sends a packet every 16 ms

Error unplugged(UsbError error) {
  return Error{fmt::format("Falcon: {} while the firmware was starting; plug the device in again", to_string(error))};
}

struct Step {
  bool done = false;
  bool cancelled = false;
  UsbError error = UsbError::none;
  std::string what{};  ///< reason for a failure
};
Step failed(std::string what) { return {.what = std::move(what)}; }
Step failed(UsbError error, std::string_view where) { return {.error = error, .what = fmt::format("{} {}", to_string(error), where)}; }

Step cancelled() { return {.cancelled = true, .what = "cancelled"}; }
bool given_up(const FalconBootOptions& options) { return options.should_abort && options.should_abort(); }

#define CATENA_USB(call, where) \
  if (const UsbError usb_error = (call); usb_error != UsbError::none) return failed(usb_error, where)

// Steps (1)-(2): handshake with the boot loader.
Step shake_hands(Ftdi& ftdi, const FalconBootOptions& options) {
  CATENA_USB(ftdi.purge(), "when entering boot mode");
  CATENA_USB(ftdi.set_latency_ms(16), "when entering boot mode");
  CATENA_USB(ftdi.set_baud(FtdiBaud::boot_9600), "when entering boot mode");
  CATENA_USB(ftdi.set_8n1(), "when entering boot mode");
  CATENA_USB(ftdi.disable_flow_control(), "when entering boot mode");
  CATENA_USB(ftdi.rts_low(), "when entering boot mode");
  CATENA_USB(ftdi.dtr_low(), "when entering boot mode");
  CATENA_USB(ftdi.dtr_high(), "when entering boot mode");
  constexpr std::uint8_t kHello[] = {0x0A, 0x43, 0x0D};
  constexpr std::uint8_t kAnswer[] = {0x0A, 0x44, 0x2C, 0x0D};  // some systems put a 0 before it
  std::size_t matched = 0;
  for (int attempt = 0; attempt < options.max_handshakes; ++attempt) {
    UsbError error = ftdi.write(kHello, kBootWriteMs);
    if (error == UsbError::disconnected) return failed(error, "during the handshake");
    for (int i = 0; i < kHandshakeReads && error == UsbError::none; ++i) {
      if (given_up(options)) return cancelled();
      std::span<const std::uint8_t> payload;
      error = ftdi.read(payload, kBootReadMs);
      if (error == UsbError::disconnected) return failed(error, "during the handshake");
      for (const std::uint8_t byte : payload) {
        matched = byte == kAnswer[matched] ? matched + 1 : (byte == kAnswer[0] ? 1 : 0);
        if (matched == std::size(kAnswer)) return {.done = true};
      }
    }
  }
  return failed(fmt::format("the boot loader did not answer {} handshakes", options.max_handshakes));
}

// Step (3): the loader is ready for an image.
Step ready_for_image(Ftdi& ftdi, const FalconBootOptions& options) {
  CATENA_USB(ftdi.dtr_low(), "before sending the image");
  CATENA_USB(ftdi.set_baud(FtdiBaud::image_140000), "before sending the image");
  constexpr std::uint8_t kAsk[] = {0x41};
  CATENA_USB(ftdi.write(kAsk, kBootWriteMs), "before sending the image");
  for (int idle = 0; idle < kEchoIdleReads; ++idle) {
    if (given_up(options)) return cancelled();
    std::span<const std::uint8_t> payload;
    const UsbError error = ftdi.read(payload, kBootReadMs);
    if (error != UsbError::none && error != UsbError::timeout) return failed(error, "before sending the image");
    // remains of a handshake may precede the answer
    for (const std::uint8_t byte : payload)
      if (byte == kAsk[0]) return {.done = true};
  }
  return failed("the boot loader did not request the image");
}

// Step (4): sends the image chunk by chunk; the loader echoes each byte.
Step send_image(Ftdi& ftdi, std::span<const std::uint8_t> image, int attempt, const FalconBootOptions& options) {
  std::size_t sent = 0, echoed = 0;
  while (echoed < image.size()) {
    if (options.progress && !options.progress(attempt, static_cast<double>(echoed) / static_cast<double>(image.size()))) return cancelled();
    const auto chunk = image.subspan(sent, std::min(kFtdiPayloadBytes, image.size() - sent));
    CATENA_USB(ftdi.write(chunk, kBootWriteMs), fmt::format("at byte {} of the image", sent));
    sent += chunk.size();
    for (int idle = 0; echoed < sent; ++idle) {
      if (given_up(options)) return cancelled();
      if (idle == kEchoIdleReads) return failed(fmt::format("byte {} of the image was not echoed", echoed));
      std::span<const std::uint8_t> payload;
      const UsbError error = ftdi.read(payload, kBootReadMs);
      if (error != UsbError::none && error != UsbError::timeout) return failed(error, fmt::format("at byte {} of the image", echoed));
      if (!payload.empty()) idle = -1;
      for (const std::uint8_t byte : payload) {
        if (echoed == sent) return failed(fmt::format("the echo is longer than the {} bytes sent", sent));
        if (byte != image[echoed])
          return failed(fmt::format("byte {} of the image was echoed as 0x{:02X}, expected 0x{:02X}", echoed, byte, image[echoed]));
        ++echoed;
      }
    }
  }
  return {.done = true};
}

// Checks whether the firmware runs: firmware answers an I/O packet with a frame; a boot loader echoes it.
Step look(Ftdi& ftdi, const FalconBootOptions& options) {
  CATENA_USB(enter_falcon_run_mode(ftdi), "when entering run mode");
  // all three LEDs: read as a frame, this would be three buttons at once, so that an echo differs from an answer
  const FalconPacket ask = encode_command({.control = kFalconRed | kFalconGreen | kFalconBlue});
  FalconFramer framer;
  UsbError last = UsbError::none;
  for (int attempt = 0; attempt < options.max_probe_packets; ++attempt) {
    last = ftdi.write(ask, kProbeReadMs);
    if (last == UsbError::disconnected) return failed(last, "during the first packets");
    for (int i = 0; i < kProbeReads && last == UsbError::none; ++i) {
      if (given_up(options)) return cancelled();
      std::span<const std::uint8_t> payload;
      last = ftdi.read(payload, kProbeReadMs);
      if (last == UsbError::disconnected) return failed(last, "during the first packets");
      for (const std::uint8_t byte : payload) {
        FalconFrame frame;
        if (!framer.push(byte, frame)) continue;
        if (encode_frame(frame) != ask) return {.done = true};
        i = kProbeReads;  // an echo
      }
    }
  }
  return {.error = last == UsbError::timeout ? UsbError::none : last, .what = "the firmware does not answer"};
}

}  // namespace

UsbError enter_falcon_run_mode(Ftdi& ftdi) noexcept {
  UsbError error = ftdi.purge();
  if (error == UsbError::none) error = ftdi.set_latency_ms(1);
  if (error == UsbError::none) error = ftdi.set_baud(FtdiBaud::run_1500000);
  if (error == UsbError::none) error = ftdi.purge();
  return error;
}

Result<bool> falcon_is_running(Ftdi& ftdi, const FalconBootOptions& options) {
  const Step step = look(ftdi, options);
  if (step.cancelled) return Error{"Falcon: cancelled while the device was examined"};
  if (!step.done && step.error == UsbError::disconnected) return unplugged(step.error);
  return step.done;
}

Outcome falcon_boot(Ftdi& ftdi, std::span<const std::uint8_t> image, const FalconBootOptions& options,
                    std::atomic<std::uint64_t>* uploads) {
  CATENA_TRY(const bool running, falcon_is_running(ftdi, options));
  if (running) return Done{};
  if (image.empty())
    return Error{
        "Falcon: the device runs no firmware, and no image was given; --firmware FILE, or \"firmware\" in the scene's \"device\", was "
        "expected: the vendor's image (a TI C2000 boot stream, part of Novint's driver package), which Catena may not distribute"};
  Step step;
  int silent = 0;
  for (int attempt = 1; attempt <= options.max_attempts; ++attempt) {
    if (uploads != nullptr) increment(*uploads);
    if (options.progress && !options.progress(attempt, 0)) return Error{"Falcon: cancelled before the firmware was sent"};
    step = shake_hands(ftdi, options);
    silent = step.done ? 0 : silent + 1;
    if (step.done) step = ready_for_image(ftdi, options);
    if (step.done) step = send_image(ftdi, image, attempt, options);
    if (step.done) step = look(ftdi, options);
    if (step.done) return Done{};
    if (step.cancelled) return Error{"Falcon: cancelled while the firmware was being sent"};
    if (step.error == UsbError::disconnected) return unplugged(step.error);
    // two attempts with a hundred handshakes each without an answer: there is no device
    if (silent == 2) return Error{fmt::format("Falcon: {}; unplug power and USB, wait a moment, and plug them in again", step.what)};
  }
  return Error{
      fmt::format("Falcon: the firmware could not be sent in {} attempts, the last problem: {}; another USB port, or the image for this "
                  "device, may help",
                  options.max_attempts, step.what)};
}

}  // namespace catena::haptics::usb
